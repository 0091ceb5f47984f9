# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The `--qos-...` arguments of the topic verbs, and the profiles they make."""

import argparse
from collections.abc import Sequence
from typing import TypeVar

from rclpy.node import Node
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)

Policy = TypeVar('Policy')

_OVERRIDES = ('depth', 'history', 'reliability', 'durability')


def add_arguments(parser: argparse.ArgumentParser, preset: str) -> None:
    """Declare the arguments, with the name of the profile that they change."""
    parser.add_argument(
        '--qos-profile',
        choices=QoSPresetProfiles.short_keys(),
        default=preset,
        help='Quality of service preset profile (default: %(default)s)',
    )
    parser.add_argument('--qos-depth', metavar='N', type=int, help='Queue size')
    for name, policy in (
        ('history', HistoryPolicy),
        ('reliability', ReliabilityPolicy),
        ('durability', DurabilityPolicy),
    ):
        parser.add_argument(
            f'--qos-{name}',
            choices=policy.short_keys(),
            help=f'Quality of service {name} (overrides that of --qos-profile)',
        )


def profile(args: argparse.Namespace) -> QoSProfile:
    """Return the profile that the arguments ask for."""
    result = QoSPresetProfiles.get_from_short_key(args.qos_profile)
    if args.qos_history:
        result.history = HistoryPolicy.get_from_short_key(args.qos_history)
    if args.qos_reliability:
        result.reliability = ReliabilityPolicy.get_from_short_key(args.qos_reliability)
    if args.qos_durability:
        result.durability = DurabilityPolicy.get_from_short_key(args.qos_durability)
    if args.qos_depth is not None:
        result.depth = args.qos_depth
    elif result.durability == DurabilityPolicy.TRANSIENT_LOCAL and result.depth == 0:
        result.depth = 1
    return result


def matching_profile(args: argparse.Namespace, node: Node, topic: str) -> QoSProfile:
    """Return a profile that receives from all publishers of a topic, unless the arguments say one.

    Reliable, or transient local, only if every publisher is: else some would not match.
    """
    result = profile(args)
    offers = [info.qos_profile for info in node.get_publishers_info_by_topic(topic)]
    if not offers or any(getattr(args, f'qos_{name}') is not None for name in _OVERRIDES):
        return result
    result.reliability = _common(
        [offer.reliability for offer in offers],
        ReliabilityPolicy.RELIABLE,
        ReliabilityPolicy.BEST_EFFORT,
    )
    result.durability = _common(
        [offer.durability for offer in offers],
        DurabilityPolicy.TRANSIENT_LOCAL,
        DurabilityPolicy.VOLATILE,
    )
    return result


def _common(offers: Sequence[Policy], strong: Policy, weak: Policy) -> Policy:
    """Return `strong` if all offers are, else `weak`, which all publishers can serve."""
    if all(offer == strong for offer in offers):
        return strong
    if strong in offers:
        print(f'Some, but not all, publishers are offering {strong!s}. Falling back to {weak!s}')
    return weak
