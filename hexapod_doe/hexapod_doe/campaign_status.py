# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line: what a campaign's folder holds, also while it runs and after a crash."""

import sys
from collections.abc import Sequence
from pathlib import Path

from hexapod_sim.command_line import CommandLine, folder, one_line
from rich.console import Console

from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.campaigns.folder import read_progress, verify_done
from hexapod_doe.campaigns.next_steps import after_status
from hexapod_doe.campaigns.overview import overview
from hexapod_doe.campaigns.page import write_page
from hexapod_doe.campaigns.progress import Progress
from hexapod_doe.designs.plan_file import PlanError

_LEAST_WIDTH = 100
_NAMED = 3


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 if the campaign is complete, 1 if it is not, 2 if the folder is none."""
    parser = CommandLine(prog='campaign_status', description=__doc__)
    parser.add_argument('directory', type=folder, help=f'folder with {PLAN_FILE}')
    parser.add_argument('--page', action='store_true', help='write the HTML page anew, too')
    parser.add_argument(
        '--verify', action='store_true', help='read back every finished bag against its digest'
    )
    parser.add_argument('--quiet', action='store_true', help='only the exit status')
    args = parser.parse_args(arguments)
    try:
        progress = _read(args.directory)
    except (PlanError, OSError) as error:
        if not args.quiet:
            print(f'campaign_status: {one_line(error)}', file=sys.stderr)
        return 2
    checked = verify_done(progress, args.directory) if args.verify else None
    if args.page:
        write_page(progress, args.directory)
    if not args.quiet:
        console = Console(highlight=False)
        if not console.is_terminal:
            console.width = max(console.width, _LEAST_WIDTH)
        console.print(overview(progress, progress.runs.values()))
        if checked is not None:
            print(f'{checked} bags read back: each as it was recorded')
        if lines := after_status(args.directory, progress):
            print('\n'.join(['', 'next:', *(f'  {line}' for line in lines)]))
    return 0 if progress.complete else 1


def _read(directory: Path) -> Progress:
    """Read a campaign's folder.

    Raises:
        PlanError: it is none, or its plan cannot be read.
    """
    if not (directory / PLAN_FILE).is_file():
        there = 'a folder without' if directory.is_dir() else 'no such folder, so there is no'
        below = sorted(path.parent for path in directory.glob(f'*/{PLAN_FILE}'))
        cure = ', such as ' + ' or '.join(map(str, below[:_NAMED])) if below else ''
        raise PlanError(
            f'{directory}: {there} {PLAN_FILE}, expected the folder of a campaign{cure}; '
            '`ros2 run hexapod_doe plan --out FOLDER/plan.csv` begins one'
        )
    return read_progress(directory)


if __name__ == '__main__':
    sys.exit(main())
