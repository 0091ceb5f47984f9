# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The recordings of a run that were cut, `<bag>.cut_<n>`, and how long they are kept.

A run goes on from one of them, and needs no other. A recording that begins leaves the one that it
went on from, or none if it begins anew, and any bag that was closed and is damaged; a bag that is
closed leaves none. What is of another run, by sensors, seed or configuration, stays.
"""

import re
import shutil
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from mcap.records import Metadata

from hexapod_doe.bags.run_bag import COMPLETE, RUN_RECORD
from hexapod_doe.bags.run_identity import EPISODES, differences, run_identity
from hexapod_doe.bags.salvage import whole_records


def cuts_of(bag: Path) -> list[Path]:
    """Return the cut recordings of a bag, the highest number first."""
    name = re.compile(rf'{re.escape(bag.name)}\.cut_(\d+)')
    numbers = {path: name.fullmatch(path.name) for path in bag.parent.glob(f'{bag.name}.cut_*')}
    found = {path: int(match[1]) for path, match in numbers.items() if match}
    return sorted(found, key=lambda path: found[path], reverse=True)


def forget_cuts(
    bag: Path, metadata: Mapping[str, str], keep: Path | None = None, closed: bool = False
) -> None:
    """Remove the cut recordings of a run that are of no use any more.

    Args:
        bag: directory that the run's bag has, or will have.
        metadata: of the run.
        keep: the cut that the run went on from.
        closed: whether the run has its bag, so that not even a damaged one is of use.
    """
    for cut in cuts_of(bag):
        if cut != keep and _is_useless(_said_of(cut / f'{bag.name}_0.mcap'), metadata, closed):
            _remove(cut)


def forget_cuts_of_closed(bag: Path) -> None:
    """Remove what a bag that is closed leaves no use for: who closed it may have been killed."""
    if cuts_of(bag):
        forget_cuts(bag, _said_of(bag / f'{bag.name}_0.mcap'), closed=True)


def _is_useless(found: Mapping[str, str], metadata: Mapping[str, str], closed: bool) -> bool:
    """Whether what a cut says of itself shows that it is of no use; it is if it says nothing."""
    if not found:
        return True
    return _same_run(found, metadata) and (closed or found.get('status') != COMPLETE)


def is_own(cut: Path, bag: Path, metadata: Mapping[str, str]) -> bool:
    """Whether a cut recording of a bag is of the run that this metadata is of."""
    return _same_run(_said_of(cut / f'{bag.name}_0.mcap'), metadata)


def _same_run(found: Mapping[str, str], metadata: Mapping[str, str]) -> bool:
    # A recording that was cut in order states how many episodes it has, not how many were due.
    identities = [
        {k: v for k, v in run_identity(each).items() if k != EPISODES}
        for each in (found, metadata)
    ]
    return found.get('run_id') == metadata.get('run_id') and not differences(*identities)


def _said_of(file: Path) -> dict[str, str]:
    """Return what a file says of its run, as far as it can be read."""
    said: dict[str, str] = {}
    try:
        with file.open('rb') as stream:
            for record in whole_records(stream):
                if isinstance(record, Metadata) and record.name == RUN_RECORD:
                    said.update(record.metadata)
    except OSError:  # nothing was written before the cut
        pass
    return said


def _remove(cut: Path) -> None:
    """Remove a folder, or the link that stands for one; a disk that refuses keeps it."""
    with suppress(OSError):
        if cut.is_symlink() or not cut.is_dir():
            cut.unlink()
        else:
            shutil.rmtree(cut)
