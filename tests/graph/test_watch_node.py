# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The watch hears the robots that somebody looks at, and does so without a word in between."""

import time
from collections.abc import Callable, Iterator

import pytest
from hexapod_bringup.watch_node import WatchNode
from hexapod_bringup.watching.board import ODOMETRY, OUTCOME, Board
from hexapod_bringup.watching.signals import JOINT_STATES, SIGNALS
from hexapod_node.session import begin
from hexapod_node.spin import spin_once
from hexapod_sim.nodes.sim_node import SimNode
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.utilities import try_shutdown

pytestmark = pytest.mark.graph


@pytest.fixture
def graph() -> Iterator[tuple[Board, WatchNode, SimNode, Callable[..., None]]]:
    """A sim in real time below the watch's namespace, and what serves both until something is."""
    begin(['--ros-args', '-r', 'sim:__ns:=/hall/w1', '-r', 'watch:__ns:=/hall',
           '-r', 'watch_sampler:__ns:=/hall', '-p', 'sync:=realtime',
           '-p', 'scene.name:=slope'])  # fmt: skip
    board, executor = Board(), EventsExecutor()
    nodes = [SimNode(), WatchNode(board)]
    for node in nodes:
        executor.add_node(node)

    def until(condition: Callable[[], object]) -> None:
        deadline = time.monotonic() + 60
        while not condition():
            assert time.monotonic() < deadline
            spin_once(executor, 0.1)

    yield board, nodes[1], nodes[0], until
    executor.shutdown()
    for node in nodes:
        node.destroy_node()
    try_shutdown()


def test_what_is_looked_at_is_heard_and_nothing_else(graph) -> None:
    board, node, sim, until = graph
    until(lambda: 'w1' in board.robots)
    assert sim.count_subscribers(JOINT_STATES) == 0
    with board.watching('w1', every=False):
        until(lambda: board.robots['w1'].pose and board.robots['w1'].joints)
        until(lambda: board.robots['w1'].track(OUTCOME).newest)
        until(lambda: board.robots['w1'].world)
        assert board.robots['w1'].world.scene.name == 'slope'
        heard = {topic for _, topic in node._sampler._open}
        assert heard == {JOINT_STATES, ODOMETRY, OUTCOME}
    with board.watching('w1', every=True):
        until(lambda: board.robots['w1'].track('imu/data').newest)
        assert len(board.robots['w1'].joints) == 18
        assert {topic for _, topic in node._sampler._open} == {*SIGNALS, ODOMETRY, OUTCOME}
    until(lambda: not node._sampler.count)
    until(lambda: sim.count_subscribers(JOINT_STATES) == 0)
    times, _ = board.robots['w1'].track('imu/data').since(0)
    assert times == sorted(set(times))
