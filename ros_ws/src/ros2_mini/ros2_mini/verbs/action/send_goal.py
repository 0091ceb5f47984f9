# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 action send_goal`: send a goal, wait for its result, cancel it if interrupted."""

import argparse
import signal
from types import FrameType
from typing import Any

import rclpy
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.action.client import ClientGoalHandle
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future

from ros2_mini import values
from ros2_mini.errors import CommandError
from ros2_mini.interfaces import load_type
from ros2_mini.message_fill import fill_message
from ros2_mini.message_text import message_to_yaml
from ros2_mini.node_context import NODE_NAME_PREFIX, open_node

_STATUS = {
    GoalStatus.STATUS_ACCEPTED: 'ACCEPTED',
    GoalStatus.STATUS_EXECUTING: 'EXECUTING',
    GoalStatus.STATUS_CANCELING: 'CANCELING',
    GoalStatus.STATUS_SUCCEEDED: 'SUCCEEDED',
    GoalStatus.STATUS_CANCELED: 'CANCELED',
    GoalStatus.STATUS_ABORTED: 'ABORTED',
}
# A signal is seen between two waits of that length [s].
_POLL_PERIOD = 0.1
_CANCEL_TIMEOUT = 5.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 action send_goal`."""
    parser.add_argument('action_name', help="Name of the ROS action (e.g. '/fibonacci')")
    parser.add_argument(
        'action_type', help="Type of the ROS action (e.g. 'example_interfaces/action/Fibonacci')"
    )
    values.add_arguments(parser, 'goal', "Goal request values in YAML format (e.g. '{order: 10}')")
    parser.add_argument(
        '-f', '--feedback', action='store_true', help='Echo feedback messages for the goal'
    )


def main(args: argparse.Namespace) -> int:
    """Send the goal and print what becomes of it; a rejected goal exits with 0, as upstream."""
    action_type = load_type(args.action_type, 'action')
    goal = action_type.Goal()
    fill_message(goal, values.given(args))
    signal.signal(signal.SIGTERM, _terminate)
    name = f'{NODE_NAME_PREFIX}_send_goal_{args.action_type.replace("/", "_")}'
    # The node must outlive a signal, to cancel the goal.
    with open_node(name, signals=SignalHandlerOptions.NO) as node:
        client = ActionClient(node, action_type, args.action_name)
        try:
            print('Waiting for an action server to become available...')
            while not client.wait_for_server(timeout_sec=_POLL_PERIOD):
                pass
            _run_goal(node, client, goal, args.feedback)
        finally:
            client.destroy()
    return 0


def _terminate(number: int, frame: FrameType | None) -> None:
    raise SystemExit(number)


def _run_goal(node: Node, client: ActionClient, goal: Any, feedback: bool) -> None:
    print(f'Sending goal:\n     {message_to_yaml(goal)}')
    handle = _wait(node, client.send_goal_async(goal, _print_feedback if feedback else None))
    if not handle.accepted:
        print('Goal was rejected.')
        return
    result = None
    try:
        print(f'Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n')
        result = _wait(node, handle.get_result_async())
    finally:
        if result is None:
            _cancel(node, handle)
    print(f'Result:\n    {message_to_yaml(result.result)}')
    print(f'Goal finished with status: {_STATUS.get(result.status, "UNKNOWN")}')


def _cancel(node: Node, handle: ClientGoalHandle) -> None:
    print('Canceling goal...')
    future = handle.cancel_goal_async()
    rclpy.spin_until_future_complete(node, future, timeout_sec=_CANCEL_TIMEOUT)
    if not future.done() or not future.result().goals_canceling:
        raise CommandError('Failed to cancel goal')
    print('Goal canceled.')


def _print_feedback(message: Any) -> None:
    print(f'Feedback:\n    {message_to_yaml(message.feedback)}')


def _wait(node: Node, future: Future) -> Any:
    while not future.done():
        rclpy.spin_once(node, timeout_sec=_POLL_PERIOD)
    if future.exception() is not None:
        raise CommandError(f'Exception while sending goal: {future.exception()!r}')
    return future.result()
