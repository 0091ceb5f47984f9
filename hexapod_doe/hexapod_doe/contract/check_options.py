# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The options of the `check_sensors` command line."""

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from hexapod_agent.contract.limits import Limits, parse_frames
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_sim.command_line import CommandLine, number, path
from hexapod_sim.sensor_table import CHANNELS

DESCRIPTION = (
    'Hold the sensors of a live graph, or of a bag, against what the agent was trained with; '
    'end with status 0 if the robot may walk with them, and with 1 if not.'
)


NAMESPACE = '__ns'
"""What stands for the namespace in a remapping rule of ROS 2."""
_OTHER_RULES = ('__node', '__name')
_TOPICS = tuple(topic for channel in CHANNELS for topic in channel.topics)


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


def parse(words: Sequence[str], ros_words: Sequence[str] = ()) -> CheckOptions:
    """Return what the command line says; ends the process where it is wrong.

    Args:
        words: before `--ros-args`.
        ros_words: after it. A node has them from ROS; for a bag the remappings among them hold.
    """
    parser = _parser()
    args = parser.parse_args(words)
    try:
        if args.bag is not None:
            args.remap += _ros_remaps(ros_words)
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


def _parser() -> CommandLine:
    parser = CommandLine(prog='check_sensors', description=DESCRIPTION)
    parser.add_argument(
        '--observations', required=True, metavar='ABCDE', help='set whose sensors are needed'
    )
    parser.add_argument('--bag', type=path, metavar='DIR', help='check a bag, not the live graph')
    parser.add_argument(
        '--seconds', type=number(gt=0), default=3.0, help='how long to listen (default 3)'
    )
    parser.add_argument(
        '--wait',
        type=number(gt=0),
        default=4.0,
        help='longest wait for first messages (default 4)',
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
        '--max-age', type=number(gt=0), default=Limits().max_age, help='in seconds (default 0.1)'
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


def _ros_remaps(words: Sequence[str]) -> list[str]:
    """Return the remapping rules among the arguments of ROS.

    Raises:
        ValueError: there is something else, which would not hold for a bag.
    """
    rules, pairs = [], iter(words)
    for word in pairs:
        rule = next(pairs, '') if word in ('-r', '--remap') else ''
        if not rule:
            raise ValueError(f"'{word}' after --ros-args: expected -r <topic>:=<other> for a bag")
        rules.append(rule)
    return rules


def _remap(text: str) -> tuple[str, str]:
    """Return a topic of the sensor table, or __ns, and what stands for it.

    Raises:
        ValueError: it is no rule, or for a topic that the table has not.
    """
    rule, mark, other = text.partition(':=')
    if not (rule and mark and other):
        raise ValueError(f"remap '{text}': expected <topic>:=<other>")
    if rule == NAMESPACE and not other.startswith('/'):
        raise ValueError(f"remap '{text}': expected a namespace that begins with '/'")
    if rule in (NAMESPACE, *_OTHER_RULES):
        return rule, other
    name = rule.rpartition(':')[2]  # a rule may be for one node: check_sensors:imu/data:=/imu
    for topic in _TOPICS:
        if name == topic or (name.startswith('/') and name.endswith(f'/{topic}')):
            return topic, other
    near = get_close_matches(name, _TOPICS, n=1)
    hint = f"did you mean '{near[0]}'?" if near else f'expected one of {", ".join(_TOPICS)}'
    raise ValueError(f"remap '{text}': the sensor table has no topic '{name}', {hint}")
