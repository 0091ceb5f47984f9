# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A sim that is faster than real time makes a time of its own, which the other nodes follow."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_node.stamps import to_nanoseconds
from hexapod_sim.nodes.sim_node import SimNode
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from hexapod_sim import robot

pytestmark = pytest.mark.graph
PERIOD = robot.CONTROL_PERIOD_NS
GIVEN = ['sync:=realtime', 'max_age:=60.0', 'sim:real_time_factor:=4.0']


@pytest.fixture
def ros_args(request) -> list[str]:
    follower = 'sim' if 'refuses' in request.node.name else 'cpg'
    given = [*GIVEN, f'{follower}:use_sim_time:=true']
    return ['--ros-args', *(word for value in given for word in ('-p', value))]


@pytest.mark.alone
def test_stamps_are_of_simulated_time_on_every_node(graph) -> None:
    sensed: list[int] = []
    commanded: list[int] = []
    for kind, topic, stamps in (
        (JointState, 'joint_states', sensed),
        (JointTrajectory, 'joint_trajectory', commanded),
    ):
        keep = lambda m, s=stamps: s.append(to_nanoseconds(m.header.stamp))  # noqa: E731
        graph.nodes[0].create_subscription(kind, topic, keep, 1000)
    graph.add(SimNode(), CpgNode())
    graph.until(lambda: len(commanded) > 5)
    first, started = sensed[-1], time.monotonic()
    graph.until(lambda: sensed[-1] > first + 4 * 1_000_000_000)
    wall_s = time.monotonic() - started
    assert wall_s < 4.0  # 1 s on a machine with time to spare
    assert np.unique(np.diff(sensed)).tolist() == [PERIOD]
    assert sensed[0] % PERIOD == 0
    assert (np.diff(commanded) > 0).all()
    assert commanded[-1] <= sensed[-1]


def test_the_sim_refuses_to_follow_the_time_that_it_makes(graph) -> None:
    with pytest.raises(ValueError, match='use_sim_time: the sim makes the time'):
        SimNode()
