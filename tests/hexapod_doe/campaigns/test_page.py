# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import re
from html.parser import HTMLParser

import pytest
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.page import PageWriter, render, write_page
from hexapod_doe.campaigns.progress import Progress, Run, State

VOID = ('meta', 'link')


class Outline(HTMLParser):
    """Collects what a page requests, its text, and whether its tags match."""

    def __init__(self) -> None:
        super().__init__()
        self.requests: list[str] = []
        self.words: list[str] = []
        self.open: list[str] = []

    def handle_starttag(self, tag, attrs):
        self.requests += [value for name, value in attrs if name in ('src', 'href')]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)


def outline(page: str) -> Outline:
    parsed = Outline()
    parsed.feed(page)
    assert not parsed.open
    return parsed


def test_the_page_says_what_the_folder_says(mixed):
    parsed = outline(render(read_progress(mixed.directory)))
    words = ' '.join(' '.join(parsed.words).split())
    assert 'done 1 failed 0 running 1 interrupted 1 due 1' in words
    assert 'episodes 8 of 20' in words
    assert '/w2 0' in words
    assert 'r3 2/5' in words


def test_the_page_requests_nothing_and_fits_a_phone_and_the_night(mixed):
    page = render(read_progress(mixed.directory))
    assert set(outline(page).requests) == {'data:,'}
    assert "default-src 'none'" in page
    assert 'width=device-width' in page
    assert 'prefers-color-scheme: dark' in page
    assert 'url(' not in page
    assert '<script' not in page


def test_reasons_are_escaped():
    run = Run('r1', 'A', State.FAILED, reason='<b>disk & full</b>')
    assert '<td colspan="6">&lt;b&gt;disk &amp; full&lt;/b&gt;</td>' in render(
        Progress('c', {'r1': run})
    )


def test_it_reloads_until_nothing_is_open(mixed):
    assert 'http-equiv="refresh"' in render(read_progress(mixed.directory))
    done = Progress('c', {'r1': Run('r1', 'A', State.DONE, '/w', 1, [1.0], 1.0, 1.0)})
    assert 'http-equiv="refresh"' not in render(done)


def test_the_articles_campaign_stays_small():
    runs = [Run(f'r{k}', 'ABC', State.DONE, '/w', 1000, [float(k)] * 1000) for k in range(320)]
    page = render(Progress('c', {run.run_id: run for run in runs}))
    assert len(page.encode()) < 200_000
    longest = max(len(points.split()) for points in re.findall(r'points="([^"]+)"', page))
    assert longest <= 32


def test_writing_leaves_one_whole_file(mixed):
    first = write_page(read_progress(mixed.directory), mixed.directory)
    before = first.stat().st_ino
    assert write_page(read_progress(mixed.directory), mixed.directory) == first
    assert first.stat().st_ino != before  # replaced, never written over
    assert [p.name for p in mixed.directory.glob('*html*')] == ['progress.html']


def test_the_writer_leaves_the_last_state(mixed):
    lines: list[str] = []
    writer = PageWriter(mixed.directory, lines.append)
    writer.refresh()
    mixed.finish('r1')
    writer.close()
    assert '<title>2/4' in (mixed.directory / 'progress.html').read_text()
    assert not lines


@pytest.mark.parametrize('obstacle', ['plan', 'page'])
def test_a_page_that_cannot_be_written_is_one_line(mixed, obstacle):
    if obstacle == 'plan':
        (mixed.directory / 'plan.csv').unlink()
    else:
        (mixed.directory / 'progress.html').mkdir()
    lines: list[str] = []
    writer = PageWriter(mixed.directory, lines.append)
    writer.refresh()
    writer.refresh()
    writer.close()
    assert len(lines) == 1
    assert str(mixed.directory) in lines[0]
