# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 lifecycle`: states and transitions of lifecycle nodes."""

import argparse
import sys

from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState
from rclpy.node import Node

from ros2_mini import node_calls
from ros2_mini.errors import CommandError
from ros2_mini.names import node_names
from ros2_mini.node_calls import asking, call
from ros2_mini.node_context import graph_node, open_node


def _get_arguments(parser: argparse.ArgumentParser) -> None:
    node_calls.add_arguments(parser)
    parser.add_argument('node_name', nargs='?', help='Name of the ROS node; all when left out')


def _get(args: argparse.Namespace) -> int:
    """Print label and number of the state of one node, or of all."""
    if args.node_name is not None:
        with asking(args) as (_, ask):
            print(_state(ask(GetState, 'get_state', GetState.Request())))
        return 0
    with graph_node(args.spin_time) as node:
        targets = _lifecycle_nodes(node, args.include_hidden_nodes)
    with open_node() as node:
        for target in targets:
            response = call(node, GetState, f'{target}/get_state', GetState.Request())
            print(f'{target}: {_state(response)}')
    return 0


def _lifecycle_nodes(node: Node, hidden: bool) -> list[str]:
    services = dict(node.get_service_names_and_types())
    kind = 'lifecycle_msgs/srv/GetState'
    names = node_names(node, hidden=hidden)
    return [name for name in names if kind in services.get(f'{name}/get_state', [])]


def _state(response: GetState.Response) -> str:
    return f'{response.current_state.label} [{response.current_state.id}]'


def _list_arguments(parser: argparse.ArgumentParser) -> None:
    node_calls.add_arguments(parser)
    parser.add_argument('node_name', help='Name of the ROS node')
    parser.add_argument(
        '-a', '--all', action='store_true', help='Display all existing transitions'
    )


def _list(args: argparse.Namespace) -> int:
    """Print each transition with the states it leads from and to."""
    service = 'get_transition_graph' if args.all else 'get_available_transitions'
    with asking(args) as (_, ask):
        response = ask(GetAvailableTransitions, service, GetAvailableTransitions.Request())
    for found in response.available_transitions:
        print(
            f'- {found.transition.label} [{found.transition.id}]\n'
            f'\tStart: {found.start_state.label}\n'
            f'\tGoal: {found.goal_state.label}'
        )
    return 0


def _set_arguments(parser: argparse.ArgumentParser) -> None:
    node_calls.add_arguments(parser)
    parser.add_argument('node_name', help='Name of the ROS node')
    parser.add_argument('transition', help='The lifecycle transition, by label or number')


def _set(args: argparse.Namespace) -> int:
    """Trigger the transition and say how it went; a failed one exits with 0, as upstream."""
    with asking(args) as (_, ask):
        request = GetAvailableTransitions.Request()
        response = ask(GetAvailableTransitions, 'get_available_transitions', request)
        known = [found.transition for found in response.available_transitions]
        chosen = [one for one in known if args.transition in (one.label, str(one.id))]
        if not chosen:
            names = ', '.join(f'{one.label} [{one.id}]' for one in known)
            raise CommandError(
                f"Unknown transition '{args.transition}' requested, available ones are: {names}"
            )
        request = ChangeState.Request(transition=chosen[0])
        succeeded = ask(ChangeState, 'change_state', request).success
    if succeeded:
        print('Transitioning successful')
    else:
        print('Transitioning failed', file=sys.stderr)
    return 0


VERBS = {
    'get': (_get_arguments, _get),
    'list': (_list_arguments, _list),
    'set': (_set_arguments, _set),
}
