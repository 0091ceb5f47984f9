# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ask a node something through a service of its own, as the param and lifecycle verbs do."""

import argparse
import contextlib
from collections.abc import Callable, Iterator
from typing import Any, TypeAlias

import rclpy
from rclpy.node import Node

from ros2_mini import discovery
from ros2_mini.errors import CommandError
from ros2_mini.names import node_names
from ros2_mini.node_context import open_node

# A node whose services are gone, or that does not answer, is given up after that [s].
_SERVICE_TIMEOUT = 5.0

Ask: TypeAlias = Callable[[Any, str, Any], Any]
"""Of a type of service, the end of its name and a request: the response."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of a verb that asks nodes something."""
    discovery.add_arguments(parser)
    parser.add_argument(
        '--include-hidden-nodes', action='store_true', help='Consider hidden nodes as well'
    )


@contextlib.contextmanager
def asking(args: argparse.Namespace) -> Iterator[tuple[str, Ask]]:
    """Yield the absolute name of the node `args.node_name`, and what asks it.

    Raises:
        CommandError: If it has not appeared within `args.spin_time`.
    """
    with open_node() as node:
        full = args.node_name if args.node_name.startswith('/') else f'/{args.node_name}'
        hidden = args.include_hidden_nodes
        if not discovery.wait_for(lambda: full in node_names(node, hidden=hidden), args.spin_time):
            raise CommandError(f"Node not found: '{full}'")
        yield full, lambda kind, name, request: call(node, kind, f'{full}/{name}', request)


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
        rclpy.spin_until_future_complete(node, future, timeout_sec=_SERVICE_TIMEOUT)
        if not future.done():
            raise CommandError(f"'{service}' has not answered within {_SERVICE_TIMEOUT} s")
        if future.exception() is not None:
            raise CommandError(f"Exception while calling '{service}': {future.exception()}")
        return future.result()
    finally:
        node.destroy_client(client)
