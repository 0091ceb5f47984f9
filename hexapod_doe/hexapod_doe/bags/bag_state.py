# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which bags there are in a folder, and which of them are complete."""

from __future__ import annotations

import os
from pathlib import Path

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.rosbag2 import METADATA_FILE, is_unfinished
from hexapod_doe.bags.run_bag import COMPLETE, EPISODE_RESULT
from hexapod_doe.errors import BagError


def is_complete(bag: str | Path) -> bool:
    """Whether the bag is closed, sound, and holds every episode that its run was to have."""
    try:
        file = BagFile(Path(bag))
        metadata = file.run_metadata()
        recorded = file.counts[file.topic_of_type(EPISODE_RESULT)]
    except BagError:
        return False
    return metadata.get('status') == COMPLETE and str(recorded) == metadata.get('episodes')


def find_bags(path: str | Path) -> list[Path]:
    """Return the closed bags at and below a folder, sorted by path."""
    root = Path(path)
    if not root.is_dir():
        raise BagError(f'{root}: no such directory, expected a folder with bags')
    # os.walk, unlike rglob, passes over a folder that is renamed meanwhile: runs go on.
    folders = (Path(folder) for folder, _, names in os.walk(root) if METADATA_FILE in names)
    return sorted(folder for folder in folders if not is_unfinished(folder))
