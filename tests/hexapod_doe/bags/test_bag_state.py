# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Bags are found in a folder that others write to."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hexapod_doe.bags.bag_state import find_bags
from hexapod_doe.bags.rosbag2 import METADATA_FILE
from hexapod_doe.errors import BagError


def make(*folders: Path) -> None:
    for folder in folders:
        folder.mkdir(parents=True)
        (folder / METADATA_FILE).write_text('')


def test_closed_bags_are_found_at_and_below_a_folder(tmp_path: Path) -> None:
    make(tmp_path / 'b', tmp_path / 'deep' / 'a', tmp_path / 'c.partial')
    (tmp_path / 'empty').mkdir()
    assert find_bags(tmp_path) == [tmp_path / 'b', tmp_path / 'deep' / 'a']
    assert find_bags(tmp_path / 'b') == [tmp_path / 'b']


def test_a_bag_that_is_renamed_meanwhile_stops_nobody(tmp_path: Path, monkeypatch) -> None:
    make(tmp_path / 'a', tmp_path / 'b.partial')
    scan = os.scandir

    def late(path):
        if str(path).endswith('b.partial'):
            (tmp_path / 'b.partial').rename(tmp_path / 'b')
        return scan(path)

    monkeypatch.setattr(os, 'scandir', late)
    assert find_bags(tmp_path) == [tmp_path / 'a']


def test_a_missing_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(BagError, match='none: no such directory, expected a folder with bags'):
        find_bags(tmp_path / 'none')
