# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The node `play` in lock-step: it has a worker play, and ends when the worker is gone."""

from __future__ import annotations

import time

import pytest
from hexapod_agent.nodes.play_node import PlayNode
from hexapod_interfaces.action import TrainRun
from rclpy.action import ActionServer
from rclpy.task import Future

pytestmark = pytest.mark.graph
TIMEOUT_S = 1.5


@pytest.fixture
def ros_args() -> list[str]:
    values = {'sync': 'lockstep', 'checkpoint': 'agent.pt', 'worker_timeout': TIMEOUT_S}
    parameters = (('-p', f'{name}:={value}') for name, value in values.items())
    return ['--ros-args', *(word for pair in parameters for word in pair)]


def test_a_worker_that_is_lost_amid_the_run_ends_it(graph) -> None:
    playing: list[TrainRun.Goal] = []

    async def play_for_ever(handle) -> TrainRun.Result:
        playing.append(handle.request)
        await Future()

    server = ActionServer(graph.nodes[0], TrainRun, 'play_run', play_for_ever)
    play = graph.add(PlayNode())
    graph.until(lambda: bool(playing))
    began = time.monotonic()
    graph.until(lambda: time.monotonic() - began > 2.0 * TIMEOUT_S)
    assert play.exit_status is None  # it is there, however long it takes
    server.destroy()
    graph.until(lambda: play.exit_status is not None)
    assert play.exit_status == 1
