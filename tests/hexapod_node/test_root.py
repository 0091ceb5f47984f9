# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Paths of requests stay below a node's root."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from hexapod_node.root import OutsideRootError, Root, root_arguments


@pytest.fixture
def root(tmp_path: Path) -> Root:
    (tmp_path / 'bags' / 'deep').mkdir(parents=True)
    (tmp_path / 'bags' / 'away').symlink_to(tmp_path)
    (tmp_path / 'bags' / 'loop').symlink_to(tmp_path / 'bags' / 'loop')
    (tmp_path / 'away').symlink_to(tmp_path / 'bags')
    (tmp_path / 'share').mkdir()
    return Root(str(tmp_path / 'bags'), f'{tmp_path}/share:{tmp_path}/one.pt:')


@pytest.mark.parametrize('path', ['bags/x', 'bags/deep/x', 'away/x', 'bags/deep/../x', 'bags/...'])
def test_what_lies_below_it_is_allowed(root: Root, tmp_path: Path, path: str) -> None:
    assert root.inside('bag', f'{tmp_path}/{path}') == (tmp_path / path).resolve()
    assert root.readable('config', f'{tmp_path}/{path}') == (tmp_path / path).resolve()


@pytest.mark.parametrize(
    'path',
    ['', '.', 'bags', 'bags/..', 'bags/../x', 'bagsx/y', 'bags/away', 'bags/away/x', 'share/x'],
)
def test_what_does_not_is_refused_by_name(root: Root, tmp_path: Path, path: str) -> None:
    with pytest.raises(OutsideRootError, match=rf"bag '.*{path}': not below '{tmp_path}/bags'"):
        root.inside('bag', f'{tmp_path}/{path}')


@pytest.mark.parametrize(
    'path', ['/etc/passwd', '~/x', '~nobody_of_that_name/x', 'x', '//x', '\0']
)
def test_no_spelling_leads_out(root: Root, path: str) -> None:
    with pytest.raises(OutsideRootError):
        root.inside('bag', path)


@pytest.mark.parametrize('path', ['a' * 300, 'a/' * 3000, 'loop/x'])
def test_what_no_file_system_takes_is_refused_in_a_short_line(
    root: Root, tmp_path: Path, path: str
) -> None:
    with pytest.raises(OutsideRootError) as refused:
        root.inside('bag', f'{tmp_path}/bags/{path}')
    assert len(str(refused.value)) < 400


def test_some_things_may_be_read_beside_it(root: Root, tmp_path: Path) -> None:
    for path in ('share/x.yaml', 'one.pt'):
        assert root.readable('config', f'{tmp_path}/{path}') == tmp_path / path
        with pytest.raises(OutsideRootError):
            root.inside('bag', f'{tmp_path}/{path}')
    with pytest.raises(OutsideRootError):
        root.readable('config', f'{tmp_path}/one.pt.old')


def test_by_default_it_is_bags_of_the_working_directory(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert Root('').folder == tmp_path / 'bags'
    assert Root('').inside('bag', 'bags/mine') == tmp_path / 'bags' / 'mine'


def test_arguments_carry_any_path() -> None:
    words = root_arguments("/a b/it's", '/x#1: y')
    assert words[::2] == ['-p', '-p']
    values = [yaml.safe_load(word.partition(':=')[2]) for word in words[1::2]]
    assert values == ["/a b/it's", '/x#1: y']
    assert root_arguments('/a') == ['-p', "root:='/a'"]
