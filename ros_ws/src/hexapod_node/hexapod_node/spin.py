# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Starts nodes, spins them and stops them: the same main for every executable."""

import faulthandler
import gc
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TypeVar

import rclpy
from rclpy.exceptions import ParameterException
from rclpy.executors import Executor, ExternalShutdownException
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.utilities import remove_ros_args

from hexapod_node import signals
from hexapod_node.progress import NoProgressError, Watchdog
from hexapod_node.session import begin
from hexapod_node.timers import raise_failure
from hexapod_node.upstream import RCLError

# EventsExecutor.spin() hangs in some builds of rclpy; a finite wait works everywhere.
_WAIT_S = 0.5
# Longest that the end of a process may take, against milliseconds as a rule. Fast DDS 2.14 waits
# for ever in DomainParticipant::set_listener, with Python's lock held, if a peer's discovery comes
# while a participant is destroyed: about once in 10,000 ends beside peers that come and go.
_TEARDOWN_S = 15.0


Nodes = TypeVar('Nodes', bound=Sequence[Node])

EXIT_STATUS = 'exit_status'
"""A node that sets an attribute of this name ends its process with that status."""


def run(make: Callable[[], Node | Sequence[Node]], args: Sequence[str] | None = None) -> None:
    """Make one node or several and spin them in one thread until a signal comes.

    Ends the process with status 0 on SIGINT and SIGTERM, and with 1 and one line of explanation
    where a parameter or a file that the nodes start from is wrong, or where the executor only
    spins. A middleware that is stuck at the end is left after 15 s, with status 1 and a traceback.
    """
    signals.take_over()
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
    except ExternalShutdownException:
        pass
    except Exception as error:
        _limit_teardown()  # what was made so far goes with the error
        status = _status_of(error, started=bool(nodes))
    finally:
        _limit_teardown()
        for node in reversed(nodes):
            node.destroy_node()
        rclpy.try_shutdown()
        signals.ignore()
    sys.exit(status)


def _status_of(error: Exception, started: bool) -> int:
    """Say what went wrong in one line and return the exit status; raise what nobody expects.

    Args:
        error: what making or spinning the nodes raised.
        started: whether they were made.
    """
    if _stopped(error):
        return 0
    starting = not started and isinstance(error, ValueError | OSError | ParameterException)
    if not starting and not isinstance(error, NoProgressError):
        raise error
    name = remove_ros_args(sys.argv)[0].rsplit('/', 1)[-1]
    print(f'{name}: {error}', file=sys.stderr)
    return 1


def _stopped(error: Exception) -> bool:
    """Whether an error is that of a callback or a start amid which a signal came: no loss."""
    known = isinstance(error, ExternalShutdownException | RCLError)
    return (known or signals.requested()) and not rclpy.ok()


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
    watchdog = Watchdog()
    try:
        while rclpy.ok():
            spin_once(executor, _WAIT_S)
            watchdog.turned()
            for node in nodes:
                if (status := getattr(node, EXIT_STATUS, None)) is not None:
                    return int(status)
        return 0
    finally:
        executor.shutdown()


@contextmanager
def serving(
    make: Callable[[], Nodes], namespace: str, arguments: Sequence[str] = ()
) -> Iterator[tuple[Executor, Nodes]]:
    """Serve nodes for as long as the context lasts, whenever `spin_once` is called.

    Args:
        make: makes them; what it raises ends the context.
        namespace: of the nodes.
        arguments: further ROS arguments for them.

    Raises:
        SystemExit: with status 0, after a signal.
    """
    before = signals.take_over()
    begin(['--ros-args', '-r', f'__ns:={namespace}', *arguments])
    executor = EventsExecutor()
    made: list[Node] = []
    try:
        nodes = make()
        made += nodes
        for node in made:
            executor.add_node(node)
        yield executor, nodes
    except Exception as error:
        if _stopped(error):
            raise SystemExit(0) from None
        raise
    finally:
        executor.shutdown()
        for node in reversed(made):
            node.destroy_node()
        rclpy.try_shutdown()
        signals.give_back(before)


def spin_once(executor: Executor, wait_s: float) -> None:
    """Serve the next event, or wait for one; raise what a timer's or a coroutine's call raised."""
    executor.spin_once(timeout_sec=wait_s)
    raise_failure()
