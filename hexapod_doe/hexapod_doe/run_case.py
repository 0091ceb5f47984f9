# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line: train one row of a plan on a worker of its own, for the jobs of a batch system.

A row that is done is left alone, one that was interrupted goes on, and the same command may be
repeated at will.
"""

import argparse
import faulthandler
import sys
from collections.abc import Sequence
from pathlib import Path

from hexapod_agent.specification.spec_text import add_spec_options
from hexapod_sim.command_line import CommandLine, file, folder, number, one_line, whole

from hexapod_doe.campaigns.campaign_lock import campaign_lock, row_lock
from hexapod_doe.campaigns.changes import Changes
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.page import write_page
from hexapod_doe.campaigns.plan_copy import keep_config, place_plan
from hexapod_doe.campaigns.row import Row, read_rows
from hexapod_doe.campaigns.stop_rule import stopped_text
from hexapod_doe.designs.plan_file import PlanError


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 if the row is done, 1 if it is not, 2 after an error of plan or options."""
    args = parser().parse_args(arguments)
    try:
        plan = place_plan(args.plan, args.out)
        row = _row(plan, args)
        state = row.bag_state(whole=True)
    except (ValueError, OSError) as error:
        print(f'run_case: {one_line(error)}', file=sys.stderr)
        return 2
    if state.other:
        print(
            f'run_case: {row.run_id} has the bag of another run ({state.other}); give the options '
            f'that it was made with, or move {row.bag} away to have the row trained anew',
            file=sys.stderr,
        )
        return 2
    if state.done:
        print(f'{row.run_id} is done: {row.bag}')
        return 0
    if text := stopped_text(plan.resolve().parent):
        print(f'{row.run_id} is not needed: {text}; run_fleet --go-on trains it')
        return 0
    if state.damage:
        print(f'run_case: {row.run_id} is trained anew: {state.damage}', file=sys.stderr)
    try:
        with campaign_lock(plan.resolve().parent, shared=True), row_lock(row.bag):
            keep_config(plan.resolve(), row.treatments.base)
            return _train(row, args)
    except (ValueError, OSError) as error:
        print(f'run_case: {one_line(error)}', file=sys.stderr)
        return 1


def _train(row: Row, args: argparse.Namespace) -> int:
    """Train the row and judge its bag."""
    from hexapod_doe.nodes.case_node import train_row  # what is done needs neither ROS nor torch

    try:
        train_row(row, args.record_every, args.stall)
    except SystemExit:  # of the nodes; after a signal it is 0, whatever the bag lacks
        faulthandler.cancel_dump_traceback_later()
    directory = row.bag.parent.parent
    write_page(read_progress(directory), directory)
    if not row.bag_state(whole=True).done:
        print(f'run_case: {row.run_id} is not done, the same command goes on', file=sys.stderr)
        return 1
    print(f'{row.run_id} is done: {row.bag}')
    return 0


def _row(plan: Path, args: argparse.Namespace) -> Row:
    """Return the row of a number in the plan's first column.

    Raises:
        PlanError: the plan has no such row.
        hexapod_agent.specification.run_spec.ConfigError: the changes to its base are none.
    """
    changes = Changes.of(args.config, args.set, args.episodes)
    rows = {int(row.metadata['StdOrder']): row for row in read_rows(plan, changes)}
    if args.row not in rows:
        raise PlanError(
            f'{plan}: no row {args.row}, expected a StdOrder of {min(rows)} to {max(rows)}'
        )
    return rows[args.row]


def parser() -> CommandLine:
    """Return what understands the command line."""
    made = CommandLine(prog='run_case', description=__doc__)
    made.add_argument('--plan', type=file, required=True, help='plan.csv of the campaign')
    made.add_argument('--row', type=whole(ge=1), required=True, help='StdOrder of the row')
    made.add_argument('--out', type=folder, help="the campaign's folder; default that of the plan")
    add_spec_options(made)
    made.add_argument(
        '--episodes', type=whole(ge=1), help='of a training; default of the specification'
    )
    made.add_argument(
        '--record-every',
        type=whole(ge=0),
        default=100,
        help='every how many episodes all topics are recorded; default %(default)s, 0 for never',
    )
    made.add_argument(
        '--stall',
        type=number(gt=0),
        default=120.0,
        help='longest time without a sign of life, in seconds; default %(default)s',
    )
    return made


if __name__ == '__main__':
    sys.exit(main())
