# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line: train the rows of a plan that are due, many at a time, without the ROS graph."""

import argparse
import math
import signal
import sys
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

import torch
from hexapod_agent.fleet.fleet import Fleet
from hexapod_agent.fleet.learners import Learners, SeparateLearners
from hexapod_agent.fleet.pool import Pool
from hexapod_agent.fleet.robots import Robots
from hexapod_agent.fleet.stacked import StackedLearners
from hexapod_agent.learning.numerics import check_precision
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.specification.spec_text import add_spec_options
from hexapod_sim.command_line import CommandLine, file, folder, number, one_line, whole

from hexapod_doe.analysis.stop_look import look_at
from hexapod_doe.campaigns.campaign import Campaign
from hexapod_doe.campaigns.campaign_lock import campaign_lock
from hexapod_doe.campaigns.changes import Changes
from hexapod_doe.campaigns.fleet_campaign import FleetCampaign
from hexapod_doe.campaigns.fleet_processes import train_in_processes
from hexapod_doe.campaigns.forecast import forecast
from hexapod_doe.campaigns.plan_copy import keep_config, place_plan
from hexapod_doe.campaigns.stop_rule import StopRule, go_on
from hexapod_doe.cores import usable_cores

_CORES = usable_cores()


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 if every run is done, 1 if some are not, 2 after an error, 130 if interrupted."""
    args = _parser().parse_args(arguments)
    try:
        with _interruptible():
            return _run(args)
    except (ValueError, OSError) as error:  # of the plan, its folder, or the configuration
        print(f'run_fleet: {one_line(error)}', file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print('run_fleet: interrupted; the same command goes on', file=sys.stderr)
        return 130


def build_fleet(specs: Sequence[RunSpec], slots: int, pool: Pool, device: str) -> Fleet:
    """Make a fleet for runs of such specifications, which learn alike: see `learning_alike`.

    On the CPU each learner computes apart and learns, to the last bit, what it learns alone. On
    any other device all learners are one stack.
    """
    learners: Learners = SeparateLearners(pool)
    if not is_cpu(device):
        widest = max(spec.observed.size for spec in specs)
        learners = StackedLearners(specs[0], widest, slots, pool, device)
    return Fleet(Robots(slots), learners, pool, slots)


def learning_alike(specs: Mapping[str, RunSpec], device: str) -> list[list[str]]:
    """Return runs in groups that can learn side by side in one process.

    A stack takes equal networks and updates. Arithmetic is set for all of a process.
    """
    groups: defaultdict[object, list[str]] = defaultdict(list)
    for name, spec in specs.items():
        alike = None if is_cpu(device) else spec.learner
        groups[spec.training.precision, alike].append(name)
    return list(groups.values())


def is_cpu(device: str) -> bool:
    """Whether a device is the processor, where learners compute apart."""
    return torch.device(device).type == 'cpu'


@contextmanager
def _interruptible() -> Iterator[None]:
    """Let SIGINT and SIGTERM interrupt, also in a background job, whose shell has one ignored."""
    signals = (signal.SIGINT, signal.SIGTERM)
    before = {each: signal.signal(each, signal.default_int_handler) for each in signals}
    try:
        yield
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)


def _run(args: argparse.Namespace) -> int:
    plan = place_plan(args.plan, args.out)
    directory = plan.resolve().parent
    changes = Changes.of(args.config, args.set, args.episodes)
    with campaign_lock(directory, shared=True):
        if args.go_on:
            go_on(directory)
        campaign = Campaign.open(plan, attempts=1, changes=changes)
        campaign.check_own()
        campaign.forget_cuts()
        for run_id, damage in campaign.damaged.items():
            print(f'run_fleet: {run_id} is trained anew: {damage}', file=sys.stderr)
        campaign.check_writable()
        due = {} if campaign.stopped else {row.run_id: row.spec for row in campaign.due}
        if is_cpu(args.device):
            for spec in due.values():
                check_precision(spec)
        keep_config(plan.resolve(), campaign.base)
        processes = args.processes or (_CORES if is_cpu(args.device) else 1)
        if due:
            workers = processes if is_cpu(args.device) else 0
            print(forecast(list(due.values()), workers))
        if processes > 1 and due:
            count = min(processes, len(due))
            options = _options(plan, args, count, len(due))
            for what in train_in_processes(directory, count, options):
                print(f'run_fleet: {what}', file=sys.stderr)
            campaign = Campaign.open(plan, attempts=1, changes=changes)
        elif due:
            _train(campaign, due, args)
    print(f'{len(campaign.done)} of {len(campaign.rows)} runs are in {campaign.directory}')
    if campaign.stopped:
        print(f'{campaign.stopped}; --go-on trains the others')
    return 0 if campaign.over else 1


def _options(plan: Path, args: argparse.Namespace, count: int, due: int) -> list[str]:
    """Return the command line of one of several processes."""
    names = ('episodes', 'config', 'slots', 'threads', 'device', 'began', 'stop_when')
    given = {'plan': plan} | {name: getattr(args, name) for name in names}
    if not is_cpu(args.device):  # its rows and the cores are shared out evenly
        given['slots'] = args.slots or math.ceil(due / count)
        given['threads'] = args.threads or max(_CORES // count, 1)
    options = [(name, value) for name, value in given.items() if value is not None]
    options += [('set', setting) for setting in args.set]
    words = [(f'--{name.replace("_", "-")}', str(value)) for name, value in options]
    return [word for pair in words for word in pair]


def _train(campaign: Campaign, due: Mapping[str, RunSpec], args: argparse.Namespace) -> None:
    """Train rows of such specifications in this process, one group after the other."""
    on_cpu = is_cpu(args.device)
    threads = args.threads or (1 if on_cpu else _CORES)
    cases = len({row.levels for row in campaign.rows})
    rule = StopRule(campaign.directory, cases, args.stop_when, look_at)
    with Pool(threads) as pool, FleetCampaign(campaign, args.device, args.began, rule) as rows:
        for group in learning_alike(due, args.device):
            specs = [due[run_id] for run_id in group]
            slots = min(args.slots or (threads if on_cpu else len(due)), len(group))
            build_fleet(specs, slots, pool, args.device).train(partial(rows.take, group))


def _parser() -> CommandLine:
    parser = CommandLine(prog='run_fleet', description=__doc__)
    parser.add_argument('--plan', type=file, required=True, help='plan.csv of the campaign')
    parser.add_argument(
        '--out', type=folder, help="the campaign's folder; default that of the plan"
    )
    parser.add_argument(
        '--episodes', type=whole(ge=1), help='of a training; default of the specification'
    )
    add_spec_options(parser)
    parser.add_argument(
        '--processes', type=whole(ge=1),
        help='default one per core on the CPU, one in all on another device',
    )  # fmt: skip
    parser.add_argument(
        '--slots', type=whole(ge=1),
        help='runs at a time in a process; default one per thread on the CPU, on another device '
        "the process's share of the rows",
    )  # fmt: skip
    parser.add_argument(
        '--threads', type=whole(ge=1),
        help='of a process; default one on the CPU, its share of the cores on another device',
    )  # fmt: skip
    parser.add_argument(
        '--stop-when', type=number(ge=0), default=0.0, metavar='D',
        help='begin no new run once the choice is expected to lose less than D, in units of the '
        'response; asked after each round of as many runs as there are cases, from the third on '
        '(default 0: never)',
    )  # fmt: skip
    parser.add_argument(
        '--go-on', action='store_true', help='with a campaign that its rule has ended'
    )
    parser.add_argument(  # what this command tells its processes
        '--began', type=datetime.fromisoformat, default=datetime.now(UTC), help=argparse.SUPPRESS
    )
    parser.add_argument(
        '--device', type=_device, default='cpu', help="where the networks are, such as 'cuda'"
    )
    return parser


def _device(text: str) -> str:
    """Check that torch can compute on a device."""
    try:
        torch.zeros(1, device=text)
    except (RuntimeError, AssertionError) as error:
        first = str(error).splitlines()[0]
        raise argparse.ArgumentTypeError(f'{text!r} cannot be used: {first}') from error
    return text


if __name__ == '__main__':
    sys.exit(main())
