# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line: what a campaign's folder holds, also while it runs and after a crash."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from hexapod_doe.bags.rosbag2 import partial_path
from hexapod_doe.campaigns.campaign import PLAN_FILE, Campaign
from hexapod_doe.designs.plan_file import PlanError


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 if every run is done, 1 if some are due, 2 if the folder is no campaign."""
    parser = argparse.ArgumentParser(prog='campaign_status', description=__doc__)
    parser.add_argument('directory', type=Path, help=f'folder with {PLAN_FILE}')
    parser.add_argument('--quiet', action='store_true', help='only the exit status')
    args = parser.parse_args(arguments)
    try:
        campaign = Campaign.open(args.directory / PLAN_FILE)
    except (PlanError, FileNotFoundError) as error:
        if not args.quiet:
            print(f'campaign_status: {error}', file=sys.stderr)
        return 2
    if not args.quiet:
        _print(campaign)
    return 0 if len(campaign.done) == len(campaign.rows) else 1


def _print(campaign: Campaign) -> None:
    for row in campaign.rows:
        state = 'due'
        if row.run_id in campaign.done:
            state = 'done'
        elif partial_path(row.bag).is_dir():
            state = 'begun'
        print(f'{row.run_id:20} {row.observations or "none":8} {state}')
    print(f'{len(campaign.done)} of {len(campaign.rows)} runs done')


if __name__ == '__main__':
    sys.exit(main())
