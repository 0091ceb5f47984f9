# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Copies the plans and finished runs of a study to the folder that is committed, in few bytes.

    python -m hexapod_doe.studies.publish /elsewhere/bags/study bags/study

also while the study runs; what is there already stays.
"""

import shutil
import sys
from collections.abc import Sequence
from pathlib import Path

from hexapod_sim.command_line import CommandLine, folder, one_line

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.repack import repack
from hexapod_doe.bags.run_bag import DIGEST
from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.campaigns.row import read_rows
from hexapod_doe.errors import AnalysisError, BagError, TableError
from hexapod_doe.studies.run_study import parts_of


def publish(study: Path, to: Path) -> int:
    """Copy what is finished and not there yet; return the number of runs that were copied.

    Raises:
        AnalysisError: There is no campaign, or another one of its name at the other place.
        BagError: A bag cannot be read or written, or another run of its name is there.
    """
    return sum(
        _publish_campaign(part.folder, to / part.folder.relative_to(study))
        for part in parts_of(study)
    )


def _publish_campaign(campaign: Path, to: Path) -> int:
    """Copy a campaign's plan and the runs that are finished."""
    for plan in (campaign / PLAN_FILE, (campaign / PLAN_FILE).with_suffix('.json')):
        _publish_plan(plan, to / plan.name)
    copied = 0
    for row in read_rows(campaign / PLAN_FILE):
        target = to / row.bag.relative_to(campaign)
        if target.is_dir():
            _check_same(row.bag, target)
        elif row.bag_state().whole:
            repack(row.bag, target)
            copied += 1
    return copied


def _publish_plan(plan: Path, to: Path) -> None:
    if not to.exists():
        to.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(plan, to)
    elif to.read_bytes() != plan.read_bytes():
        raise AnalysisError(f'{to}: another plan than {plan}, expected the same campaign')


def _check_same(bag: Path, copy: Path) -> None:
    """Refuse a bag of which the copy holds other messages; one that is not here is no fault."""
    if not bag.is_dir():
        return
    found, expected = (BagFile(each).run_metadata().get(DIGEST) for each in (copy, bag))
    if found != expected:
        raise BagError(f'bag {copy}: digest {found}, expected {expected} as {bag} has it')


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 after a copy, 2 after an error."""
    parser = CommandLine(prog='publish', description=__doc__)
    parser.add_argument('study', type=folder, help='folder above those of the campaigns')
    parser.add_argument('to', type=folder, help='folder to copy them to')
    args = parser.parse_args(arguments)
    try:
        copied = publish(args.study, args.to)
    except (AnalysisError, BagError, TableError, ValueError, OSError) as error:
        print(f'publish: {one_line(error)}', file=sys.stderr)
        return 2
    size = sum(path.stat().st_size for path in args.to.rglob('*') if path.is_file())
    print(f'{copied} runs copied; {args.to} holds {size / 1e6:.1f} MB')
    return 0


if __name__ == '__main__':
    sys.exit(main())
