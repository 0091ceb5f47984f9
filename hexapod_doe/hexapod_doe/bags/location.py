# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Where a bag is: a directory of rosbag2, or one MCAP file of it by itself."""

import os
from collections.abc import Iterator
from pathlib import Path

from hexapod_doe.bags.mcap_file import is_mcap
from hexapod_doe.bags.rosbag2 import METADATA_FILE, is_unfinished, partial_path
from hexapod_doe.errors import BagError

CONVERT = '`ros2 bag convert` it, or `rosbags-convert --src BAG --dst NEW --dst-storage mcap`'
"""The cure for a bag of another storage."""
_OTHER_SUFFIXES = ('.db3', '.bag')
_EXPECTED = 'expected a rosbag2 directory with MCAP storage, or one .mcap file'


def user_path(path: str | Path) -> Path:
    """Return a path with `~` as the home directory: not every way here goes through a shell."""
    try:
        return Path(path).expanduser()
    except RuntimeError:  # a user who does not exist: then it is a name like any other
        return Path(path)


def located(path: str | Path) -> Path:
    """Return the directory of a bag, or the MCAP file that is to be read by itself.

    Raises:
        BagError: there is neither; the text says what there is, and what to give instead.
    """
    place = user_path(path)
    if place.name == METADATA_FILE and place.is_file():
        place = place.parent
    reason = _reason(place)
    if reason:
        raise BagError(f'bag {place}: {reason}')
    return place


def bag_folders(root: Path) -> Iterator[Path]:
    """Yield the directories of closed bags at and below a folder, once, following links."""
    seen: set[str] = set()
    # os.walk, unlike rglob, passes over a folder that is renamed meanwhile: runs go on.
    for folder, below, names in os.walk(root, followlinks=True):
        real = os.path.realpath(folder)
        if real in seen:  # a link leads back, or twice to one place
            below.clear()
            continue
        seen.add(real)
        below.sort()
        if METADATA_FILE in names and not is_unfinished(Path(folder)):
            yield Path(folder)


def _reason(place: Path) -> str:
    """Return why a path is no bag; '' if it is one."""
    if not place.is_dir():
        return '' if is_mcap(place) and place.is_file() else _no_directory(place)
    if (place / METADATA_FILE).is_file():
        return ''
    return _no_metadata(place)


def _no_directory(place: Path) -> str:
    if place.suffix in _OTHER_SUFFIXES and place.is_file():
        return f"storage '{place.suffix[1:]}', {_EXPECTED}; cure: {CONVERT}"
    if place.exists():
        return f'is a file, {_EXPECTED}'
    partial = partial_path(place)
    if partial.is_dir():
        return f'the recording was not finished, {partial} is what there is, {_EXPECTED}'
    return f'no such directory, {_EXPECTED}'


def _no_metadata(place: Path) -> str:
    below = sorted(bag_folders(place))
    if below:
        bags = 'one bag' if len(below) == 1 else f'{len(below)} bags'
        return f'is a folder with {bags} below it, expected a bag itself; cure: give {below[0]}'
    files = sorted(file for file in place.iterdir() if is_mcap(file))
    if files:
        return f'no {METADATA_FILE}, {_EXPECTED}; cure: give {files[0]}, or `ros2 bag reindex` it'
    return f'no {METADATA_FILE}, {_EXPECTED}'
