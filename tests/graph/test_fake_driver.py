# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Fake drivers in lock-step: a perfect one is not noticed, a bad one is and is repeatable."""

from __future__ import annotations

import pytest
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning.training import Trainer
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.train import train_episode
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_interfaces.action import TrainRun
from hexapod_interfaces.msg import EpisodeResult
from hexapod_node.matching import subscribed_topics
from hexapod_sim.nodes.fake_driver_node import FakeDriverNode
from hexapod_sim.nodes.sim_node import SimNode
from rclpy.parameter import Parameter

pytestmark = pytest.mark.graph
SMALL = """
task: {time_limit_steps: 40}
ddpg: {batch_size: 16, update_every: 4}
actor: {hidden: [16, 12]}
critic: {hidden: [16, 12]}
training: {episodes: 2, evaluation: 0}
observations: C
"""


def driver(name: str, **settings: object) -> FakeDriverNode:
    """Return a driver with parameters of its own."""
    return FakeDriverNode(name, [Parameter(key, value=value) for key, value in settings.items()])


@pytest.fixture
def ros_args(request) -> list[str]:
    """Return the remappings of the agent to the topics that a test names."""
    topics = getattr(request, 'param', ())
    return ['--ros-args', *(word for t in topics for word in ('-r', f'agent:{t}:=driver/{t}'))]


def returns(graph, *drivers: FakeDriverNode) -> list[float]:
    """Train two short episodes through the drivers; return what they earned."""
    heard: list[EpisodeResult] = []
    node = graph.nodes[0]
    node.create_subscription(EpisodeResult, 'episode_result', heard.append, 10)
    graph.add(*drivers, SimNode(), CpgNode(), AgentNode())
    for each in drivers:
        each_topics = [s.topic_name for s in each.subscriptions]
        graph.until(
            lambda made=each, wanted=each_topics: (
                set(wanted) <= set(subscribed_topics(node, made.get_name(), '/'))
            )
        )
    goal = TrainRun.Goal(run_id='r', spec=SMALL, seed=3)
    assert graph.train(goal).result.message == ''
    graph.until(lambda: len(heard) == 2)
    assert all((r.late, r.missing, r.duplicate) == (0, 0, 0) for r in heard)
    return [result.episode_return for result in heard]


@pytest.fixture
def plain() -> list[float]:
    """Return what the same run earns without drivers, and without ROS."""
    spec = RunSpec.from_text(SMALL, 'a test')
    trainer, env = Trainer(spec, 3), HexapodLine(config=spec)
    return [train_episode(env, trainer).episode_return for _ in range(2)]


@pytest.fixture(scope='module')
def earlier() -> list[list[float]]:
    """Return the list of what earlier tests have found."""
    return []


def test_a_fault_that_the_channel_cannot_have_is_refused(graph) -> None:
    imu = graph.add(driver('imu', channel='imu/data'))
    (answer,) = imu.set_parameters([Parameter('fault', value='wrong_length')])
    assert not answer.successful
    assert "fault 'wrong_length': expected one of , stopped" in answer.reason
    assert imu.set_parameters([Parameter('fault', value='bad_quaternion')])[0].successful


SWAPPED = ('imu/data', 'joint_states')


@pytest.mark.parametrize('ros_args', [SWAPPED], indirect=True)
def test_perfect_drivers_in_lock_step_change_no_bit(graph, plain) -> None:
    joints = driver('joints', channel='joint_states', sync='lockstep', joint_order='shuffled',
                    joint_prefix='px/', extra_joints=2)  # fmt: skip
    imu = driver('imu', channel='imu/data', sync='lockstep')
    assert returns(graph, joints, imu) == plain


@pytest.mark.parametrize('ros_args', [SWAPPED[:1]], indirect=True)
@pytest.mark.parametrize('again', [False, True])
def test_a_bad_driver_in_lock_step_is_noticed_and_repeatable(
    graph, plain, earlier, again: bool
) -> None:
    imu = driver('imu', channel='imu/data', sync='lockstep', noise=0.2, delay=0.05, dropout=0.3,
                 rate=20.0, quantisation=0.01, bias=0.1, seed=7)  # fmt: skip
    found = returns(graph, imu)
    assert found != plain
    earlier.append(found)
    assert found == earlier[0]
    assert len(earlier) == 1 + again
