# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which bags there are in a folder, and which of them are complete."""

from pathlib import Path

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.location import bag_folders, user_path
from hexapod_doe.bags.mcap_file import is_mcap
from hexapod_doe.bags.run_bag import COMPLETE, DIGEST, evaluation_of
from hexapod_doe.bags.verify import check_bytes
from hexapod_doe.errors import BagError, UnfinishedError


def is_complete(bag: str | Path) -> bool:
    """Whether the bag is closed, sound, and holds every episode that its run was to have."""
    return complete_metadata(bag) is not None


def complete_metadata(bag: str | Path) -> dict[str, str] | None:
    """Return what a complete bag says of its run; None if there is none."""
    try:
        return sound_metadata(bag)
    except BagError:
        return None


def sound_metadata(bag: str | Path) -> dict[str, str]:
    """Return what a bag says of its run, once every byte of it is found as it was written.

    Raises:
        UnfinishedError: it lacks episodes of its run.
        BagError: it is missing or damaged.
    """
    file = BagFile(Path(bag))
    metadata = file.run_metadata()
    recorded = file.counts[file.result_topic()]
    if metadata.get('status') != COMPLETE or str(recorded) != metadata.get('episodes'):
        raise UnfinishedError(
            f'bag {bag}: {recorded} episode results, status {metadata.get("status")!r}, expected '
            f'{metadata.get("episodes")} and {COMPLETE!r}'
        )
    evaluated, due = sum(file.counts[t] for t in file.evaluation_topics()), evaluation_of(metadata)
    if evaluated != due:
        raise UnfinishedError(f'bag {bag}: {evaluated} results of its evaluation, expected {due}')
    check_bytes(file, metadata.get(DIGEST))
    return metadata


def find_bags(path: str | Path) -> list[Path]:
    """Return the closed bags at and below a folder, sorted by path; an MCAP file is one itself.

    Raises:
        BagError: there is no such folder.
    """
    root = user_path(path)
    if is_mcap(root) and root.is_file():
        return [root]
    if not root.is_dir():
        reason = 'is a file' if root.exists() else 'no such directory'
        raise BagError(f'{root}: {reason}, expected a folder with bags')
    return sorted(bag_folders(root))
