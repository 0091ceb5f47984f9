# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Coroutines are resumed by the event that they wait for, and cost nothing while they wait."""

import threading
import time

import pytest
from hexapod_interfaces.srv import ResetEpisode
from hexapod_node.coroutines import (
    ServiceUnavailableError,
    call,
    in_thread,
    sleep,
    start,
    until,
    until_lost,
)
from rclpy.task import Future

pytestmark = pytest.mark.graph


def test_a_coroutine_goes_on_inside_the_call_that_sets_the_future() -> None:
    first, second = Future(), Future()

    async def work() -> int:
        return await until(first) + await until(second)

    done = start(work())
    first.set_result(1)
    assert not done.done()
    second.set_result(2)
    assert done.result() == 3


def test_an_exception_reaches_whoever_holds_the_future() -> None:
    failing = Future()

    async def work() -> None:
        await until(failing)

    done = start(work())
    failing.set_exception(ValueError('expected'))
    with pytest.raises(ValueError, match='expected'):
        done.result()


def test_waiting_uses_no_processor_time(graph) -> None:
    done = start(sleep(graph.nodes[0], 1.0))
    began = time.process_time()
    graph.until(done.done)
    assert time.process_time() - began < 0.5


def test_a_service_without_a_server_is_named(graph) -> None:
    client = graph.nodes[0].create_client(ResetEpisode, 'sim/reset')
    done = start(call(graph.nodes[0], client, ResetEpisode.Request(), 0.3))
    graph.until(done.done)
    with pytest.raises(ServiceUnavailableError, match=r'/sim/reset: no server within 0.3 s'):
        done.result()


def test_timers_go_on_while_the_work_does(graph) -> None:
    node = graph.nodes[0]
    gate = threading.Event()
    ticks: list[int] = []

    def tick() -> None:
        ticks.append(len(ticks))
        if len(ticks) == 5:
            gate.set()

    node.create_timer(0.01, tick)
    assert graph.result(start(in_thread(node, lambda: gate.wait(10.0))))
    assert len(ticks) >= 5


def test_error_of_the_work_is_raised_where_it_is_awaited(graph) -> None:
    def fail() -> None:
        raise OSError('disk full')

    with pytest.raises(OSError, match='disk full'):
        graph.result(start(in_thread(graph.nodes[0], fail)))


def test_whoever_owes_an_answer_is_missed_once_gone_for_long(graph) -> None:
    """Absence counts from when it was seen last; an answer ends the wait at once."""
    node, answer = graph.nodes[0], Future()
    gone_until = [time.monotonic() + 1.0]
    waiting = start(until_lost(node, answer, lambda: time.monotonic() > gone_until[0], 1.5))
    graph.until(lambda: time.monotonic() > gone_until[0] + 1.0)
    assert not waiting.done()
    answer.set_result('an answer')
    graph.until(waiting.done, 0.2)
    assert waiting.result() is True
    began = time.monotonic()
    lost = start(until_lost(node, Future(), lambda: False, 0.6))
    assert graph.result(lost) is False
    assert time.monotonic() - began < 3.0
