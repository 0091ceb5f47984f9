# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line: what a campaign's folder holds, also while it runs and after a crash."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from hexapod_sim.command_line import CommandLine, folder, one_line
from rich.console import Console

from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.next_steps import after_status
from hexapod_doe.campaigns.overview import overview
from hexapod_doe.campaigns.page import write_page
from hexapod_doe.campaigns.progress import State
from hexapod_doe.designs.plan_file import PlanError

_LEAST_WIDTH = 100


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 if every run is done, 1 if some are not, 2 if the folder is no campaign."""
    parser = CommandLine(prog='campaign_status', description=__doc__)
    parser.add_argument('directory', type=folder, help=f'folder with {PLAN_FILE}')
    parser.add_argument('--page', action='store_true', help='write the HTML page anew, too')
    parser.add_argument('--quiet', action='store_true', help='only the exit status')
    args = parser.parse_args(arguments)
    try:
        progress = read_progress(args.directory)
    except (PlanError, OSError) as error:
        if not args.quiet:
            print(f'campaign_status: {one_line(error)}', file=sys.stderr)
        return 2
    if args.page:
        write_page(progress, args.directory)
    if not args.quiet:
        console = Console(highlight=False)
        if not console.is_terminal:
            console.width = max(console.width, _LEAST_WIDTH)
        console.print(overview(progress, progress.runs.values()))
        if lines := after_status(args.directory, progress):
            print('\n'.join(['', 'next:', *(f'  {line}' for line in lines)]))
    return 0 if len(progress.having(State.DONE)) == len(progress.runs) else 1


if __name__ == '__main__':
    sys.exit(main())
