# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A node serves others while work of its own takes long."""

import threading

import pytest
from hexapod_node.coroutines import in_thread, start

pytestmark = pytest.mark.graph


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
