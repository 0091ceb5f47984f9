# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Copies closed bags into as few chunks as they fill.

A recording ends a chunk with each episode, so that a crash loses none; a bag of many episodes and
no sampled topics is a third as large without that.
"""

from pathlib import Path

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.bag_state import sound_metadata
from hexapod_doe.bags.run_bag import DIGEST
from hexapod_doe.bags.salvage import BagCopy, whole_records
from hexapod_doe.errors import BagError


def repack(bag: Path, target: Path) -> Path:
    """Write a complete bag anew, with the same messages, times and metadata; return the new one.

    Args:
        bag: directory of the bag, which stays as it is.
        target: directory that the copy will have.

    Raises:
        BagError: the bag is not complete, there is something at the target already, or the copy
            cannot be written.
    """
    digest = sound_metadata(bag).get(DIGEST)
    copy = BagCopy(target)
    file = BagFile(bag)
    for path in file.files:
        with file.opened(path) as stream:
            for record in whole_records(stream):
                copy.take(record)
    new = copy.close(copy.metadata)
    found = BagFile(new).run_metadata()[DIGEST]
    if digest is not None and found != digest:
        raise BagError(f'bag {new}: digest {found}, expected {digest} as {bag} has it')
    return new
