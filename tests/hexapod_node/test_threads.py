# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A node serves others while work of its own takes long."""

import threading

import pytest
import rclpy
from hexapod_node.coroutines import start
from hexapod_node.threads import in_thread
from rclpy.experimental.events_executor import EventsExecutor

pytestmark = pytest.mark.graph


@pytest.fixture
def executor():
    rclpy.init()
    made = EventsExecutor()
    made.node = rclpy.create_node('busy')
    made.add_node(made.node)
    yield made
    made.node.destroy_node()
    made.shutdown()
    rclpy.shutdown()


def result(executor, future):
    while not future.done():
        executor.spin_once(timeout_sec=0.05)
    return future.result()


def test_timers_go_on_while_the_work_does(executor):
    gate = threading.Event()
    ticks: list[int] = []

    def tick() -> None:
        ticks.append(len(ticks))
        if len(ticks) == 5:
            gate.set()

    executor.node.create_timer(0.01, tick)
    working = start(in_thread(executor.node, lambda: gate.wait(10.0)))
    assert result(executor, working)
    assert len(ticks) >= 5


def test_error_of_the_work_is_raised_where_it_is_awaited(executor):
    def fail() -> None:
        raise OSError('disk full')

    with pytest.raises(OSError, match='disk full'):
        result(executor, start(in_thread(executor.node, fail)))
