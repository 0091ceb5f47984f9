# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The options of the `check_sensors` command line."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from hexapod_agent.contract.limits import Limits, parse_frames
from hexapod_agent.observation import ObservationSpec

DESCRIPTION = (
    'Hold the sensors of a live graph, or of a bag, against what the agent was trained with; '
    'end with status 0 if the robot may walk with them, and with 1 if not.'
)


@dataclass(frozen=True)
class CheckOptions:
    """What to check, where, and how strictly."""

    spec: ObservationSpec
    bag: Path | None
    seconds: float
    wait: float
    remaps: dict[str, str]
    limits: Limits
    reliable: bool
    json: str
    """File for the outcome, '-' for the standard output, '' for none."""


def parse(words: Sequence[str]) -> CheckOptions:
    """Return what the command line says; ends the process where it is wrong."""
    parser = _parser()
    args = parser.parse_args(words)
    try:
        return CheckOptions(
            spec=ObservationSpec(args.observations),
            bag=args.bag,
            seconds=args.seconds,
            wait=args.wait,
            remaps=dict(_remap(text) for text in args.remap),
            limits=Limits(max_age=args.max_age, frames=parse_frames(args.frames)),
            reliable=args.sync == 'lockstep',
            json=args.json,
        )
    except ValueError as error:
        parser.error(str(error))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog='check_sensors', description=DESCRIPTION)
    parser.add_argument(
        '--observations', required=True, metavar='ABCDE', help='set whose sensors are needed'
    )
    parser.add_argument('--bag', type=Path, metavar='DIR', help='check a bag, not the live graph')
    parser.add_argument(
        '--seconds', type=_positive, default=3.0, help='how long to listen (default 3)'
    )
    parser.add_argument(
        '--wait', type=_positive, default=4.0, help='longest wait for first messages (default 4)'
    )
    parser.add_argument(
        '-r',
        '--remap',
        action='append',
        default=[],
        metavar='TOPIC:=OTHER',
        help="a driver's own name of a topic; also __ns:=/NAMESPACE",
    )
    parser.add_argument(
        '--frames', default='', metavar='TOPIC=FRAME …', help='frames whose axes equal ours'
    )
    parser.add_argument(
        '--max-age', type=_positive, default=Limits().max_age, help='in seconds (default 0.1)'
    )
    parser.add_argument(
        '--sync',
        choices=('realtime', 'lockstep'),
        default='realtime',
        help='how the agent will run; in lock-step it needs reliable publishers',
    )
    parser.add_argument(
        '--json', default='', metavar='FILE', help="also write the outcome; '-' prints just that"
    )
    return parser


def _positive(text: str) -> float:
    value = float(text)
    if not value > 0.0:
        raise argparse.ArgumentTypeError(f'{text}: expected a positive number')
    return value


def _remap(text: str) -> tuple[str, str]:
    topic, mark, other = text.partition(':=')
    if not (topic and mark and other):
        raise ValueError(f"remap '{text}': expected <topic>:=<other>")
    return topic, other
