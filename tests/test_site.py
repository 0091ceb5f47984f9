# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The documentation as a site: strict links, nothing from elsewhere, and a search that needs none.

`make docs` makes the environment that builds it; without that the tests are skipped.
"""

from __future__ import annotations

import re
import subprocess
from html.parser import HTMLParser
from pathlib import Path

import pytest
from browser import OVERFLOW, Browser, in_every_look, needs_browser
from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parents[1]
PYTHON = ROOT / '.venv-docs' / 'bin' / 'python'
PAGES = ('index', 'architecture', 'specification')
LOADING = {'script': 'src', 'img': 'src', 'link': 'href', 'iframe': 'src', 'source': 'src'}
SEARCHED = """(() => {
    const field = document.querySelector('input.md-search__input');
    field.focus();
    field.value = 'closeness_weight';
    field.dispatchEvent(new KeyboardEvent('keyup', {bubbles: true}));
    return document.querySelector('.md-search-result__link');
})()"""
BACKGROUNDS = {'light': 'rgb(255, 255, 255)', 'dark': 'rgb(30, 33, 41)'}
needs_builder = pytest.mark.skipif(
    not PYTHON.exists(), reason='needs mkdocs in an environment of its own: `make docs`'
)


class Loaded(HTMLParser):
    """Collects the addresses of what a page loads."""

    def __init__(self) -> None:
        super().__init__()
        self.addresses: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if tag in LOADING and given.get('rel') not in ('canonical', 'next', 'prev'):
            self.addresses.append(given.get(LOADING[tag]) or '')


def build(config: Path, target: Path) -> subprocess.CompletedProcess[str]:
    command = [PYTHON, '-m', 'mkdocs', 'build', '--strict']
    return subprocess.run(
        [*command, '--config-file', config, '--site-dir', target],
        capture_output=True,
        text=True,
        cwd=ROOT,
    )


@pytest.fixture(scope='session')
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site as it is built from this repository."""
    target = tmp_path_factory.mktemp('site')
    ended = build(ROOT / 'mkdocs.yml', target)
    assert ended.returncode == 0, ended.stderr
    return target


@needs_builder
def test_nothing_is_loaded_from_elsewhere(site: Path) -> None:
    pages = sorted(site.rglob('*.html'))
    assert len(pages) > 20
    for page in pages:
        loaded = Loaded()
        loaded.feed(page.read_text(encoding='utf-8'))
        assert loaded.addresses
        outside = [address for address in loaded.addresses if re.match(r'(\w+:)?//', address)]
        assert outside == [], page


@needs_builder
def test_links_out_of_the_docs_lead_to_pages_of_the_site(site: Path) -> None:
    shown = (site / 'source/hexapod_sim/hexapod_sim/article.yaml.html').read_text(encoding='utf-8')
    assert 'closeness_weight' in shown
    keys = (site / 'specification.html').read_text(encoding='utf-8')
    assert 'href="source/hexapod_sim/hexapod_sim/article.yaml.html"' in keys
    study = (site / 'study.html').read_text(encoding='utf-8')
    assert 'href="bags/study/index.html"' in study


@needs_builder
def test_a_link_that_leads_nowhere_is_refused(tmp_path: Path) -> None:
    (tmp_path / 'docs').mkdir()
    (tmp_path / 'docs' / 'index.md').write_text('# Page\n\n[a](gone.md) [b](#nowhere)\n')
    given = (ROOT / 'mkdocs.yml').read_text(encoding='utf-8')
    given = re.sub(r'^(nav:\n)(  .*\n)+', 'nav:\n  - Start: index.md\n', given, flags=re.MULTILINE)
    given = given.replace('hooks: [.ci/site_pages.py]', '')
    (tmp_path / 'mkdocs.yml').write_text(given, encoding='utf-8')
    ended = build(tmp_path / 'mkdocs.yml', tmp_path / 'site')
    assert ended.returncode != 0
    assert 'gone.md' in ended.stderr
    assert '#nowhere' in ended.stderr


def test_what_builds_it_is_pinned_and_apart() -> None:
    def read(name: str) -> dict[str, str]:
        lines = (line.split('#')[0].strip() for line in (ROOT / name).read_text().splitlines())
        made = [Requirement(line) for line in lines if line]
        return {made.name.lower(): str(made.specifier) for made in made}

    docs = read('requirements-docs.txt')
    assert all(pin.startswith('==') for pin in docs.values())
    others = read('constraints.txt') | read('requirements.txt') | read('requirements-dev.txt')
    assert not docs.keys() & others.keys()


@needs_builder
@needs_browser
@in_every_look
@pytest.mark.parametrize('page', PAGES)
def test_pages_are_drawn(browser: Browser, site: Path, page: str, width: int, theme: str) -> None:
    address = (site / f'{page}.html').as_uri()
    browser.open(address, width, theme)
    browser.wait_for("document.readyState === 'complete'")
    assert browser.run(f'return {OVERFLOW};') <= 0
    look = 'return getComputedStyle(document.body).backgroundColor;'
    assert browser.run(look) == BACKGROUNDS[theme]
    assert browser.run("return document.querySelector('h1').getBoundingClientRect().height;") > 20
    broken = 'return [...document.images].filter(i => !i.naturalWidth).map(i => i.src);'
    assert browser.run(broken) == []
    assert browser.complaints() == []
    assert all(each.startswith(site.as_uri()) for each in browser.requests())


@needs_builder
@needs_browser
def test_the_search_finds_without_a_network(browser: Browser, site: Path) -> None:
    browser.open((site / 'index.html').as_uri(), 1280, 'light')
    browser.wait_for("document.querySelector('input.md-search__input')")
    browser.wait_for(SEARCHED)  # typed again until the index is loaded
    links = "return [...document.querySelectorAll('.md-search-result__link')].map(a => a.href);"
    assert any('specification.html' in link for link in browser.run(links))
    assert browser.complaints() == []
