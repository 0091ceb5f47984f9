# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The pages for people: links lead somewhere, and files and commands that they name are there."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PAGES = [
    *ROOT.glob('*.md'),
    *ROOT.glob('.github/*.md'),
    *ROOT.glob('docs/**/*.md'),
    *ROOT.glob('examples/*.md'),
    *ROOT.glob('bags/*.md'),
    *ROOT.glob('tests/data/**/*.md'),
    *ROOT.glob('ros_ws/src/*/*.md'),
    *ROOT.glob('ros_ws/src/hexapod_bringup/agents/*.md'),
]
RECIPES = [*ROOT.glob('.github/workflows/*.yml'), *ROOT.glob('docker/*')]
_LINK = re.compile(r'\]\(([^)\s]+)\)')
_FENCE = re.compile(r'^```.*?^```$', re.MULTILINE | re.DOTALL)
_HEADING = re.compile(r'^#+ (.*)$', re.MULTILINE)
# A file of ours with its folder: the first part is a folder of this repository.
_PATH = re.compile(r'(?<![\w/.:-])((?:[\w.-]+/)+[\w.-]+\.(?:py|yaml|xml|md|c|pt|bash))(?![\w*{])')
_COMMAND = re.compile(r'ros2 (run|launch) (hexapod_\w+) (\w+(?:\.launch\.xml)?)')


def named(page: Path) -> str:
    return str(page.relative_to(ROOT))


def prose(page: Path) -> str:
    return _FENCE.sub('', page.read_text(encoding='utf-8'))


def anchors(page: Path) -> set[str]:
    """Return the anchors of a page's headings, as GitHub makes them."""
    found: dict[str, int] = {}
    made = set()
    for heading in _HEADING.findall(prose(page)):
        plain = re.sub(r'[^\w\- ]', '', _LINK.sub(']', heading).lower()).replace(' ', '-')
        count = found[plain] = found.get(plain, -1) + 1
        made.add(f'{plain}-{count}' if count else plain)
    return made


@pytest.mark.parametrize('page', PAGES, ids=named)
def test_links_lead_somewhere(page: Path) -> None:
    links = [link for link in _LINK.findall(prose(page)) if '://' not in link]
    for link in links:
        file, _, anchor = link.partition('#')
        target = (page.parent / file).resolve() if file else page
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


@pytest.mark.parametrize('page', PAGES, ids=named)
def test_files_that_a_page_names_are_there(page: Path) -> None:
    ours = {path.name for path in ROOT.iterdir() if path.is_dir()} - {'bags', 'runs'}
    paths = {path for path in _PATH.findall(prose(page)) if path.split('/')[0] in ours}
    missing = sorted(path for path in paths if not (ROOT / path).exists())
    assert missing == []


@pytest.mark.parametrize('page', [*PAGES, *RECIPES], ids=named)
def test_commands_that_a_page_names_are_there(page: Path) -> None:
    for verb, package, name in set(_COMMAND.findall(page.read_text(encoding='utf-8'))):
        folder = ROOT / 'ros_ws/src' / package
        if verb == 'launch':
            assert (folder / 'launch' / name).is_file(), f'{package} {name}'
        else:
            assert f"'{name} = " in (folder / 'setup.py').read_text(), f'{package} {name}'


def test_make_help_lists_the_verbs_that_the_pages_name() -> None:
    ended = subprocess.run(
        ['make', '-C', str(ROOT), '-s', 'help'], capture_output=True, text=True, check=True
    )
    verbs = {line.split()[0] for line in ended.stdout.splitlines() if line}
    said = {verb for page in PAGES for verb in re.findall(r'`make ([a-z-]+)`', page.read_text())}
    assert said <= verbs


def test_a_broken_link_is_found(tmp_path: Path) -> None:
    page = tmp_path / 'page.md'
    page.write_text('# One `two` 3\n[a](#one-two-3) [b](gone.md)\n```\n[c](code.md)\n```\n')
    assert anchors(page) == {'one-two-3'}
    with pytest.raises(AssertionError, match=r'gone\.md'):
        test_links_lead_somewhere(page)
