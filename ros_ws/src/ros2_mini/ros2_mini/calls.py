# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ask a node something through a service of its own, as the param and lifecycle verbs do."""

import argparse
from typing import Any

import rclpy
from rclpy.node import Node
from rclpy.task import Future

from ros2_mini import discovery
from ros2_mini.discovery import wait_for
from ros2_mini.errors import CommandError
from ros2_mini.names import absolute, node_names

# A node whose services are gone, or that does not answer, is given up after that [s].
_SERVICE_TIMEOUT = 5.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of a verb that asks nodes something."""
    discovery.add_arguments(parser)
    parser.add_argument(
        '--include-hidden-nodes', action='store_true', help='Consider hidden nodes as well'
    )


def find_node(node: Node, name: str, args: argparse.Namespace) -> str:
    """Return the absolute name of a node once it has appeared in the graph.

    Raises:
        CommandError: If it has not within `args.spin_time`.
    """
    full = absolute(name)
    hidden = args.include_hidden_nodes
    if not wait_for(lambda: full in node_names(node, hidden=hidden), args.spin_time):
        raise CommandError(f"Node not found: '{full}'")
    return full


def call(node: Node, service_type: Any, service: str, request: Any) -> Any:
    """Return the response to a request.

    Raises:
        CommandError: If the service does not appear, or does not answer.
    """
    client = node.create_client(service_type, service)
    try:
        if not client.wait_for_service(timeout_sec=_SERVICE_TIMEOUT):
            raise CommandError(f"Wait for service timed out waiting for '{service}'")
        future = client.call_async(request)
        return result_of(node, future, service, _SERVICE_TIMEOUT)
    finally:
        node.destroy_client(client)


def result_of(node: Node, future: Future, what: str, timeout: float | None = None) -> Any:
    """Return the result of a future, spinning `node` until it is there.

    Args:
        node: The node that the future belongs to.
        future: The future.
        what: What is asked, for the error message.
        timeout: Longest time to wait [s]; for ever when None.

    Raises:
        CommandError: If the future fails or is not done in time.
    """
    rclpy.spin_until_future_complete(node, future, timeout_sec=timeout)
    if not future.done():
        raise CommandError(f"'{what}' has not answered within {timeout} s")
    if future.exception() is not None:
        raise CommandError(f"Exception while calling '{what}': {future.exception()}")
    return future.result()
