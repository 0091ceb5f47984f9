# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""An executor that only spins is told from one that works, and ends its process."""

import subprocess
import sys

import pytest
from hexapod_node.progress import NoProgressError, Watchdog, served


class Time:
    now = 0.0

    def __call__(self) -> float:
        return self.now


def turn(watchdog: Watchdog, time: Time, spins: int, callbacks: int, seconds: float) -> None:
    """Spread so many turns and callbacks over so many seconds."""
    for index in range(spins):
        time.now += seconds / spins
        if index * callbacks // spins != (index + 1) * callbacks // spins:
            served()
        watchdog.turned()


@pytest.mark.parametrize(
    ('spins', 'callbacks'),
    [
        (60_000, 45_000),  # a worker in lock-step
        (200_000, 10_000),  # twenty events of the middleware for each callback
        (40, 0),  # nothing to do: the loop wakes by itself
        (4_000, 10),  # messages that nobody wants
    ],
)
def test_work_and_idleness_are_progress(spins: int, callbacks: int) -> None:
    time = Time()
    turn(Watchdog(10.0, time), time, spins, callbacks, 21.0)


def test_a_storm_is_none_within_two_windows() -> None:
    time = Time()
    watchdog = Watchdog(10.0, time)
    turn(watchdog, time, 30_000, 25_000, 9.0)
    with pytest.raises(NoProgressError, match=r'woke up 3\d+ times within 10 s and served 2\d+ '):
        turn(watchdog, time, 90_000, 50, 25.0)
    assert time.now < 30.0


SPINNING = """
import hexapod_node.spin as spin
from hexapod_node.progress import Watchdog
from rclpy.node import Node

class Spinning(Node):
    def __init__(self):
        super().__init__('spinning')
        self.create_timer(0.01, self.again)
    def again(self):
        self.executor.create_task(self.again)

spin.Watchdog = lambda: Watchdog(0.5)
spin.run(lambda: Spinning())
"""


def test_a_process_that_only_spins_ends_with_a_message() -> None:
    done = subprocess.run(
        [sys.executable, '-c', SPINNING], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 1
    assert 'the executor woke up' in done.stderr
    assert 'Traceback' not in done.stderr
