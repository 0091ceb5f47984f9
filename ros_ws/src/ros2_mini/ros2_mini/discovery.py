# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Wait until the graph is known: the original asks a daemon, this command looks for itself."""

import argparse
import time
from collections.abc import Callable
from typing import TypeVar

from hexapod_node.environment import domain_id
from hexapod_node.participants import participants_here
from rclpy.node import Node

Found = TypeVar('Found')

# Participants announce themselves every 3 s: whoever is there has been heard of after that [s].
ANNOUNCEMENT_PERIOD = 3.0
DEFAULT_LIMIT = ANNOUNCEMENT_PERIOD + 0.5
# The graph is taken for complete when it has not changed for so long [s] ...
_QUIET = 0.15
# ... and this old at least, where the participants of this host cannot be counted [s].
_LEAST = 0.5
_PERIOD = 0.02

_DISCOVERY_TOPIC = 'ros_discovery_info'  # every context has one publisher of it
_UNKNOWN_NODE = '_NODE_NAME_UNKNOWN_'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of verbs that look at the graph."""
    parser.add_argument(
        '--spin-time',
        type=float,
        default=DEFAULT_LIMIT,
        help='Longest time to wait for discovery, in seconds (default: %(default)s)',
    )
    parser.add_argument('--no-daemon', action='store_true', help='Accepted; there is no daemon')


def wait_for(look: Callable[[], Found], limit: float) -> Found:
    """Return what `look` returns as soon as that is true, at the latest after `limit` seconds."""
    deadline = time.monotonic() + limit
    while not (found := look()) and time.monotonic() < deadline:
        time.sleep(_PERIOD)
    return found


def wait_until_settled(node: Node, limit: float) -> None:
    """Wait until every participant is known and the graph has stopped changing.

    Args:
        node: The node that looks.
        limit: Longest time to wait [s].
    """
    start = changed = time.monotonic()
    last = None
    while (now := time.monotonic()) < start + limit:
        if (graph := _snapshot(node)) != last:
            last, changed = graph, now
        expected = participants_here(domain_id())
        complete = _discovered(node) >= expected if expected else now > start + _LEAST
        if complete and now > changed + _QUIET:
            return
        time.sleep(_PERIOD)


def _discovered(node: Node) -> int:
    """Return how many participants are known whose nodes have names."""
    infos = node.get_publishers_info_by_topic('/parameter_events')
    if any(info.node_name == _UNKNOWN_NODE for info in infos):
        return 0
    return len(node.get_publishers_info_by_topic(_DISCOVERY_TOPIC, no_mangle=True))


def _snapshot(node: Node) -> object:
    return (
        sorted(node.get_node_names_and_namespaces()),
        node.get_topic_names_and_types(),
        node.get_service_names_and_types(),
    )
