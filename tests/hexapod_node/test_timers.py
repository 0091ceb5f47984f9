# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A node's timers: in time, on a grid, gone with the node, alive after pauses of the process."""

from __future__ import annotations

import gc
import subprocess
import sys
import threading
import time
import weakref
from collections.abc import Callable, Iterator

import pytest
import rclpy
from hexapod_node.coroutines import pause, sleep, start
from hexapod_node.spin import spin_once
from hexapod_node.timers import call_every, call_later, call_soon, cancel_all
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node

pytestmark = pytest.mark.graph
Spin = Callable[[float], None]


@pytest.fixture
def node() -> Iterator[Node]:
    rclpy.init()
    made = Node('timers')
    yield made
    made.destroy_node()
    rclpy.shutdown()


@pytest.fixture
def spin(node: Node) -> Iterator[Spin]:
    """Return what serves the node for so many seconds."""
    executor = EventsExecutor()
    executor.add_node(node)

    def serve(seconds: float) -> None:
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            spin_once(executor, left)

    yield serve
    executor.shutdown()


@pytest.mark.alone
def test_calls_come_when_they_are_due_and_in_their_order(node: Node, spin: Spin) -> None:
    called: list[tuple[str, float]] = []
    began = time.monotonic()
    for name, seconds in (('late', 0.08), ('early', 0.02), ('now', 0.0)):
        call_later(node, seconds, lambda n=name: called.append((n, time.monotonic() - began)))
    spin(0.2)
    assert [name for name, _ in called] == ['now', 'early', 'late']
    for (_, at), due in zip(called, (0.0, 0.02, 0.08), strict=True):
        assert due <= at < due + 0.1


@pytest.mark.alone
def test_a_periodic_call_keeps_its_grid_and_serves_a_pause_once(node: Node, spin: Spin) -> None:
    called: list[float] = []
    began_ns = time.monotonic_ns()
    call_every(node, 0.02, lambda: called.append((time.monotonic_ns() - began_ns) * 1e-9))
    spin(0.1)
    time.sleep(0.3)  # 15 periods
    before = len(called)
    spin(0.005)
    assert before < len(called) <= before + 2  # a busy machine takes longer than told
    spin(0.1)
    assert all(at % 0.02 < 0.018 for at in called[before + 1 :])
    assert len(called) <= before + 7


def spin_until(spin: Spin, called: list) -> None:
    """Serve until something was called; a busy machine may take its time."""
    end = time.monotonic() + 10.0
    while not called and time.monotonic() < end:
        spin(0.03)
    assert called


def test_what_is_cancelled_is_not_called(node: Node, spin: Spin) -> None:
    called: list[int] = []
    timer = call_every(node, 0.005, lambda: called.append(1))
    spin_until(spin, called)
    timer.cancel()
    count = len(called)
    spin(0.03)
    assert count == len(called)


def test_a_coroutine_that_began_before_its_node_was_served_goes_on(node: Node) -> None:
    done = start(sleep(node, 0.0))
    executor = EventsExecutor()
    time.sleep(0.05)
    executor.add_node(node)
    end = time.monotonic() + 10.0
    while not done.done() and time.monotonic() < end:
        spin_once(executor, 0.1)
    executor.shutdown()
    assert done.done()


def test_any_thread_may_ask(node: Node, spin: Spin) -> None:
    called: list[str] = []
    name = threading.current_thread().name
    ask = lambda: call_soon(node, lambda: called.append(threading.current_thread().name))  # noqa: E731
    threading.Thread(target=ask).start()
    spin_until(spin, called)
    assert called == [name]


def test_what_a_call_raises_reaches_whoever_spins(node: Node, spin: Spin) -> None:
    def fail() -> None:
        raise KeyError('expected')

    call_later(node, 0.001, fail)
    with pytest.raises(KeyError, match='expected'):
        spin(1.0)


def test_a_pause_lets_others_have_their_turn(node: Node, spin: Spin) -> None:
    order: list[str] = []

    async def work() -> None:
        await pause(node)
        order.append('after')

    call_soon(node, lambda: order.append('other'))
    start(work())
    spin_until(spin, order)
    spin(0.05)
    assert order == ['other', 'after']


def test_timers_do_not_keep_a_node() -> None:
    rclpy.init()
    made = Node('brief')
    call_every(made, 3600.0, made.get_name)
    call_later(made, 0.001, made.get_name)
    time.sleep(0.05)
    made.destroy_node()
    gone = weakref.ref(made)
    cancel_all(made)
    del made
    gc.collect()
    time.sleep(0.05)
    gc.collect()
    rclpy.shutdown()
    assert gone() is None


# What the loops of a campaign's manager do, with pauses at random, as an overloaded machine makes.
STORM = """
import random, time
import rclpy
from hexapod_node.coroutines import sleep, start
from hexapod_node.spin import spin_once
from hexapod_node.timers import call_every
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node

rclpy.init()
node, count = Node('storm'), dict(ticks=0, wakes=0, spins=0)
def tick(): count['ticks'] += 1
async def loop(seconds):
    while True:
        await sleep(node, seconds)
        count['wakes'] += 1
call_every(node, 0.05, tick)
for seconds in (0.01, 0.01, 0.02, 0.02, 0.03):
    start(loop(seconds))
executor = EventsExecutor()
executor.add_node(node)
def spin(seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        spin_once(executor, 0.05)
        count['spins'] += 1
chance = random.Random(2)
for _ in range(20):
    time.sleep(chance.choice([0.03, 0.06, 0.12, 0.25]))
    spin(chance.choice([0.0005, 0.002, 0.01, 0.05]))
count.update(ticks=0, wakes=0, spins=0)
spin(1.0)
print(count['ticks'], count['wakes'], count['spins'], len(list(node.timers)))
"""


def test_sleeps_and_ticks_survive_pauses_of_the_process() -> None:
    done = subprocess.run(
        [sys.executable, '-c', STORM], capture_output=True, text=True, timeout=120, check=True
    )
    ticks, wakes, spins, timers = map(int, done.stdout.split())
    assert 10 <= ticks <= 21
    assert spins <= 3 * (ticks + wakes) + 50
    assert timers == 0
