# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Starts nodes, spins them and stops them: the same main for every executable."""

from __future__ import annotations

import faulthandler
import gc
import sys
from collections.abc import Callable, Sequence

import rclpy
from rclpy.exceptions import ParameterException
from rclpy.executors import ExternalShutdownException
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.utilities import remove_ros_args

from hexapod_node.session import begin

# EventsExecutor.spin() hangs in some builds of rclpy; a finite wait works everywhere.
_WAIT_S = 0.5
# Longest that the end of a process may take, against milliseconds as a rule. Fast DDS 2.14 waits
# for ever in DomainParticipant::set_listener, with Python's lock held, if a peer's discovery comes
# while a participant is destroyed: about once in 10,000 ends beside peers that come and go.
_TEARDOWN_S = 15.0


EXIT_STATUS = 'exit_status'
"""A node that sets an attribute of this name ends its process with that status."""


def run(make: Callable[[], Node | Sequence[Node]], args: Sequence[str] | None = None) -> None:
    """Make one node or several and spin them in one thread until a signal comes.

    Ends the process with status 0 on SIGINT and SIGTERM, and with 1 and one line of explanation
    where a parameter or a file that the nodes start from is wrong. A middleware that is stuck at
    the end is left after 15 s, with status 1 and a traceback.
    """
    begin(args)
    nodes: list[Node] = []
    status = 0
    try:
        made = make()
        nodes = [made] if isinstance(made, Node) else list(made)
        # A full garbage collection looks at every object of every library, for many milliseconds
        # of a control period. What is there now stays, so it is left out from here on.
        gc.freeze()
        status = spin(nodes)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except rclpy_implementation.RCLError:
        if rclpy.ok():  # else the signal came amid a callback, which could not publish any more
            raise
    except (ValueError, OSError, ParameterException) as error:
        if nodes:  # not a matter of starting: show where it came from
            raise
        _limit_teardown()  # what was made so far goes with the error
        name = remove_ros_args(sys.argv)[0].rsplit('/', 1)[-1]
        print(f'{name}: {error}', file=sys.stderr)
        status = 1
    finally:
        _limit_teardown()
        for node in reversed(nodes):
            node.destroy_node()
        rclpy.try_shutdown()
    sys.exit(status)


def _limit_teardown() -> None:
    """Let a thread that needs no Python lock end the process if it hangs from here on."""
    faulthandler.dump_traceback_later(_TEARDOWN_S, exit=True)


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
