# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The node that a verb works through, from its start to its end."""

import contextlib
import os
import signal
from collections.abc import Iterator
from importlib.resources import as_file, files

import rclpy
from hexapod_node.environment import provide_log_directory
from hexapod_node.upstream import RCLError
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from ros2_mini.discovery import DEFAULT_LIMIT, wait_until_settled

_PROFILES = 'FASTRTPS_DEFAULT_PROFILES_FILE'


@contextlib.contextmanager
def open_node() -> Iterator[Node]:
    """Yield a hidden node, and take it down again.

    Raises:
        SystemExit: With the number of SIGTERM, if that has ended the node.
        EnvironmentVariableError: ROS's logs cannot be written.
    """
    provide_log_directory()
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.ALL)
    node = rclpy.create_node(f'_ros2cli_{os.getpid()}', start_parameter_services=False)
    try:
        yield node
        if not rclpy.ok():
            raise ExternalShutdownException
    except (ExternalShutdownException, RCLError) as error:
        if rclpy.ok():
            raise
        # What was just under way when the signal came returns early, or fails in its own way.
        raise SystemExit(int(signal.SIGTERM)) from error
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


@contextlib.contextmanager
def graph_node(limit: float = DEFAULT_LIMIT) -> Iterator[Node]:
    """Yield a node that only looks, once it knows the graph.

    Args:
        limit: Longest time to wait for that [s].
    """
    with contextlib.ExitStack() as stack:
        with _quick_discovery():
            node = stack.enter_context(open_node())
        wait_until_settled(node, limit)
        yield node


@contextlib.contextmanager
def _quick_discovery() -> Iterator[None]:
    """Let a participant made meanwhile use our settings, unless the user has chosen others."""
    if _PROFILES in os.environ:
        yield
        return
    with as_file(files('ros2_mini') / 'quick_discovery.xml') as profiles:
        os.environ[_PROFILES] = str(profiles)
        try:
            yield
        finally:
            del os.environ[_PROFILES]
