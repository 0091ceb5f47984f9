# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Hooks of mkdocs: the site also has what its pages link to outside of `docs/`.

Markdown becomes a page, README.md the first one; a file of text becomes a page that shows it. A
section of the navigation that names a folder lists the pages of that folder.
"""

import posixpath
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parents[1]
DOCS = 'docs/'
FIRST = 'README.md'
_LINK = re.compile(r'(\]\()([^)\s#:]+)((?:#[^)\s]*)?\))')
_FENCE = re.compile(r'(^```.*?^```$)', re.MULTILINE | re.DOTALL)
_LANGUAGES = {'.cff': 'yaml', '.py': 'python', '.xml': 'xml', '.yaml': 'yaml', '.yml': 'yaml'}

_origins: dict[str, str] = {}
"""By the address of a page: what it is made of, below the root of the repository."""


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Let sections that name a folder list its pages, and leave out those without any."""
    config.nav = [item for given in config.nav or [] for item in _listed(given)]
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add what is linked to, and what that links to."""
    _origins.clear()
    _origins.update({file.src_uri: DOCS + file.src_uri for file in files})
    due = [*(path for path in _origins.values() if path.endswith('.md')), FIRST]
    while due:
        path = due.pop()
        if _address(path) not in _origins:
            _origins[_address(path)] = path
            files.append(File.generated(config, _address(path), content=_content(path)))
        if path.endswith('.md'):
            linked = (_target(path, link[2]) for link in _LINK.finditer(_content(path)))
            due += [target for target in linked if target and _address(target) not in _origins]
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Lead links to where the site has what they name."""
    origin = _origins[page.file.src_uri]
    here = posixpath.dirname(page.file.src_uri) or '.'

    def moved(link: re.Match[str]) -> str:
        target = _target(origin, link[2])
        return (
            f'{link[1]}{posixpath.relpath(_address(target), here)}{link[3]}' if target else link[0]
        )

    parts = _FENCE.split(markdown)
    return ''.join(part if part.startswith('```') else _LINK.sub(moved, part) for part in parts)


def _listed(item: Any) -> Iterator[Any]:
    """Yield an entry of the navigation; of a folder its pages, in the order of their names."""
    (title, value), *_ = item.items()
    if not (isinstance(value, str) and value.endswith('/')):
        yield item
    elif pages := sorted((ROOT / DOCS / value).glob('*.md')):
        index = [page for page in pages if page.stem in ('index', 'README')]
        order = [*index, *(page for page in pages if page not in index)]
        yield {title: [value + page.name for page in order]}


def _target(origin: str, link: str) -> str | None:
    """Return the file that a link of a page leads to, below the root; None if there is none."""
    path = posixpath.normpath(posixpath.join(posixpath.dirname(origin), link))
    if (ROOT / path).is_dir():
        path = f'{path}/README.md'
    return path if not path.startswith('../') and (ROOT / path).is_file() else None


def _address(path: str) -> str:
    """Return where the site has a file."""
    if path.startswith(DOCS):
        return path.removeprefix(DOCS)
    if path == FIRST:
        return 'index.md'
    if path.endswith('.md'):
        return path.lstrip('.').lower().replace('readme.md', 'index.md')
    return f'source/{path}' + ('' if path.endswith('.png') else '.md')


def _content(path: str) -> str:
    """Return a page's text, or a page that shows a file."""
    text = (ROOT / path).read_text(encoding='utf-8')
    if path.endswith('.md'):
        return text
    language = _LANGUAGES.get(Path(path).suffix, 'text')
    unsought = '---\nsearch:\n  exclude: true\n---\n'  # the search finds the pages that explain it
    return f'{unsought}# {Path(path).name}\n\n`{path}`\n\n````{language}\n{text.rstrip()}\n````\n'
