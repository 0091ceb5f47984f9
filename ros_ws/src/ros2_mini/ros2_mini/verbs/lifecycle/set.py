# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 lifecycle set`: trigger a transition of a lifecycle node."""

import argparse
import sys

from ros2_mini import calls
from ros2_mini.calls import find_node
from ros2_mini.errors import CommandError
from ros2_mini.lifecycles import change_state, get_transitions
from ros2_mini.node_context import open_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 lifecycle set`."""
    calls.add_arguments(parser)
    parser.add_argument('node_name', help='Name of the ROS node')
    parser.add_argument('transition', help='The lifecycle transition, by label or number')


def main(args: argparse.Namespace) -> int:
    """Trigger the transition and say how it went; a failed one exits with 0, as upstream."""
    with open_node() as node:
        target = find_node(node, args.node_name, args)
        known = [found.transition for found in get_transitions(node, target)]
        chosen = [one for one in known if args.transition in (one.label, str(one.id))]
        if not chosen:
            names = ', '.join(f'{one.label} [{one.id}]' for one in known)
            raise CommandError(
                f"Unknown transition '{args.transition}' requested, available ones are: {names}"
            )
        succeeded = change_state(node, target, chosen[0])
    if succeeded:
        print('Transitioning successful')
    else:
        print('Transitioning failed', file=sys.stderr)
    return 0
