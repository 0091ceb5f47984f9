# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Whole control periods from topics of the same process."""

from __future__ import annotations

import pytest
from hexapod_interfaces.msg import CpgState
from hexapod_node.coroutines import start
from hexapod_node.intra_process import LockStepPublisher
from hexapod_node.lock_step import LockStep
from hexapod_node.stamps import time_message
from hexapod_node.timers import call_soon
from rclpy.node import Node

pytestmark = pytest.mark.graph
PERIOD_NS, PERIODS = 25_000_000, 20


def test_others_have_a_turn_while_nobody_has_to_be_waited_for(graph) -> None:
    node = graph.add(Node('player'))
    publisher = LockStepPublisher(node, CpgState, 'cpg/state')
    lock_step = LockStep(node, {'cpg/state': CpgState}, PERIOD_NS, 5.0)
    graph.until(lambda: publisher.get_subscription_count() == 1)
    played: list[int] = []
    turns: list[int] = []

    async def play() -> None:
        lock_step.start(0)
        call_soon(node, lambda: turns.append(len(played)))
        for period in range(PERIODS):
            message = CpgState()
            message.header.stamp = time_message(period * PERIOD_NS)
            publisher.publish(message)
            await lock_step.next_period()
            played.append(period)

    done = start(play())
    graph.until(done.done)
    assert done.result() is None
    assert played == list(range(PERIODS))
    assert turns
    assert turns[0] < 8
