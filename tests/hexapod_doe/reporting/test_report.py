# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The page is one file that needs nothing, and everything it shows lies beside it."""

import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pandas as pd
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.records.options import Options
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.report import render, sections
from hexapod_doe.tables.csv_table import read_csv

DATA = Path(__file__).parents[2] / 'data' / 'doe_cases'
VOID = {'meta', 'link', 'br', 'img', 'hr', 'input'}


class _Page(HTMLParser):
    """Collects links, sources and unbalanced tags."""

    def __init__(self, text):
        super().__init__()
        self.links, self.sources, self.open, self.ids = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.links += [attributes['href']] if tag == 'a' else []
        self.sources += [v for k, v in attrs if k in ('src', 'srcset', 'data')]
        self.ids += [attributes['id']] if 'id' in attributes else []
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.ids += [value for name, value in attrs if name == 'id']

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


@pytest.fixture(params=['tour_page', 'campaign_page'])
def page(request):
    """The path of a written page."""
    return request.getfixturevalue(request.param)


def test_the_page_is_well_formed_and_its_ids_are_unique(page):
    parsed = _Page(page.read_text(encoding='utf-8'))
    assert not parsed.open
    assert len(parsed.ids) == len(set(parsed.ids))


def test_the_page_requests_nothing(page):
    text = page.read_text(encoding='utf-8')
    parsed = _Page(text)
    assert not parsed.sources
    assert '<script' not in text
    assert '@import' not in text
    assert not re.search(r'url\((?!#)', text)
    assert "default-src 'none'" in text
    outside = [link for link in parsed.links if re.match(r'\w+:|//', link)]
    assert not outside


def test_every_link_leads_to_something(page):
    parsed = _Page(page.read_text(encoding='utf-8'))
    for link in parsed.links:
        if link.startswith('#'):
            assert link[1:] in parsed.ids
        elif link != 'analysis.json':  # written by the command line
            assert (page.parent / link).stat().st_size > 0


def test_every_figure_has_its_png_and_its_numbers(campaign, campaign_page):
    charts = [c for s in sections(campaign) for c in s.items if isinstance(c, Chart)]
    assert len(charts) >= 14
    for chart in charts:
        png = (campaign_page.parent / 'figures' / f'{chart.name}.png').read_bytes()
        assert png.startswith(b'\x89PNG')
        table = pd.read_csv(campaign_page.parent / 'tables' / f'{chart.name}.csv')
        assert len(table) == len(chart.data) > 0


def test_colours_follow_the_theme(page):
    text = page.read_text(encoding='utf-8')
    drawings = ''.join(re.findall(r'<svg.*?</svg>', text, flags=re.DOTALL))
    assert 'var(--blue)' in drawings
    assert not re.findall(r'#[0-9a-f]{6}\b', drawings)


def test_the_first_line_of_the_tour_says_what_it_is(tour_page):
    text = re.sub(r'<style>.*?</style>', '', tour_page.read_text('utf-8'), flags=re.DOTALL)
    body = text[text.index('<body>') :]
    lines = [line.strip() for line in re.sub(r'<[^>]*>', '\n', body).splitlines()]
    first = next(line for line in lines if line)
    assert first.startswith('Four episodes are a tour, not a conclusion')


def test_the_same_analysis_gives_the_same_page(tour):
    first, again = (render(tour, sections(tour)[:1]) for _ in range(2))
    assert first == again


def test_the_article_mode_has_its_figures(article):
    names = {item.name for section in sections(article) for item in section.items}
    expected = {'residual_histogram_initial', 'residual_histogram_final', 'main_effects'}
    expected |= {'normal_probability_final', 'ranked_predictions', 'steps', 'elimination'}
    assert expected | {'learning_curves', 'transform'} <= names


@pytest.mark.parametrize(
    ('case', 'response'), [('oxygen_2_2_cp', 'y'), ('filtration_2_4', 'y'), ('plasma_2_3_r2', 'y')]
)
def test_tables_of_other_shapes_have_a_report(case, response):
    # Centre points, a saturated model, replicates of a full factorial; none has learning curves.
    tables = read_csv(DATA / f'{case}.csv', response)
    analysis = analyse(tables, Options(eliminate=False))
    text = render(analysis, sections(analysis))
    assert '<figure id="figure-main_effects"' in text
    assert 'learning_curves' not in text


def test_text_from_outside_is_escaped(tour):
    text = render(replace(tour, title='<script>alert(1)</script>'), [])
    assert '<script' not in text
    assert '&lt;script&gt;alert(1)' in text


def test_no_drawing_says_nan(page):
    drawings = re.findall(r'<svg.*?</svg>', Path(page).read_text('utf-8'), flags=re.DOTALL)
    assert drawings
    assert not [d for d in drawings if re.search(r'>nan<|"[^"]*\bnan\b[^"]*"', d)]
