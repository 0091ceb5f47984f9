# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Starts nodes, spins them and stops them: the same main for every executable."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence

import rclpy
from rclpy.exceptions import ParameterException
from rclpy.executors import ExternalShutdownException
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.utilities import remove_ros_args

# EventsExecutor.spin() hangs in some builds of rclpy; a finite wait works everywhere.
_WAIT_S = 0.5


EXIT_STATUS = 'exit_status'
"""A node that sets an attribute of this name ends its process with that status."""


def run(make: Callable[[], Node | Sequence[Node]], args: Sequence[str] | None = None) -> None:
    """Make one node or several and spin them in one thread until a signal comes.

    Ends the process with status 0 on SIGINT and SIGTERM, and with 1 and one line of explanation
    where a parameter or a file that the nodes start from is wrong.
    """
    rclpy.init(args=list(args) if args is not None else None)
    nodes: list[Node] = []
    status = 0
    try:
        made = make()
        nodes = [made] if isinstance(made, Node) else list(made)
        status = spin(nodes)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except (ValueError, OSError, ParameterException) as error:
        if nodes:  # not a matter of starting: show where it came from
            raise
        name = remove_ros_args(sys.argv)[0].rsplit('/', 1)[-1]
        print(f'{name}: {error}', file=sys.stderr)
        status = 1
    finally:
        for node in reversed(nodes):
            node.destroy_node()
        rclpy.try_shutdown()
    sys.exit(status)


def spin(nodes: Sequence[Node]) -> int:
    """Serve the nodes' callbacks in the order of their events, until shutdown or an exit status.

    Returns:
        The exit status that a node asked for; 0 at shutdown.
    """
    executor = EventsExecutor()
    for node in nodes:
        executor.add_node(node)
    try:
        while rclpy.ok():
            executor.spin_once(timeout_sec=_WAIT_S)
            for node in nodes:
                if (status := getattr(node, EXIT_STATUS, None)) is not None:
                    return int(status)
        return 0
    finally:
        executor.shutdown()
