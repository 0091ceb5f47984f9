# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A checkpoint played on the graph: the figures of the environment, and its own observations."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hexapod_agent.deployment import agent_file
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_interfaces.action import TrainRun
from hexapod_interfaces.msg import EpisodeResult
from hexapod_node.matching import subscribed_topics
from hexapod_sim.nodes.sim_node import SimNode

from hexapod_agent import evaluate

pytestmark = pytest.mark.graph
SMALL = {
    'task': {'time_limit_steps': 40},
    'actor': {'hidden': [16, 12]},
    'critic': {'hidden': [16, 12]},
}
ONE = 'training: {episodes: 1}'


@pytest.fixture
def path(tmp_path) -> str:
    """Return an untrained checkpoint of the channels B and C."""
    trainer = Trainer(RunSpec.from_mapping(SMALL, 'small').observing('BC'), 5)
    # Weights large enough that the observation decides the action.
    trainer.learner.networks.actor_parameters.flat.mul_(4.0)
    checkpoint.save_agent(tmp_path / 'agent.pt', trainer)
    return str(tmp_path / 'agent.pt')


@pytest.fixture(params=['ddpg', 'td3', 'sac', 'ppo'])
def agent(request: pytest.FixtureRequest, path: str, tmp_path: Path) -> str:
    """Return an untrained checkpoint of each algorithm."""
    if request.param == 'ddpg':
        return path
    learner = {'algorithm': request.param, request.param: {'hidden': [16, 12]}}
    spec = RunSpec.from_mapping({'task': SMALL['task'], 'learner': learner}, 'small')
    checkpoint.save_agent(tmp_path / 'agent.pt', Trainer(spec.observing('BC'), 5))
    return str(tmp_path / 'agent.pt')


def figures(path: str, *options: str) -> dict[str, float]:
    file = f'{path}.json'
    evaluate.main([path, '--starts', '3', '--seed', '9', '--json', file, *options])
    with open(file) as text:
        return json.load(text)


def test_evaluation_on_the_graph_equals_the_environments(agent: str) -> None:
    alone = figures(agent)
    assert alone['speed'] != 0.0
    assert figures(agent, '--graph') == alone


def test_playing_subscribes_to_the_checkpoints_channels_and_learns_nothing(
    graph, path: str
) -> None:
    seen: list[set[str]] = []
    node = graph.nodes[0]

    class Watched(SimNode):
        def _on_joint_trajectory(self, message) -> None:
            super()._on_joint_trajectory(message)
            seen.append(set(subscribed_topics(node, 'agent', '/')))

    graph.add(Watched(), CpgNode(), AgentNode())
    response = graph.train(TrainRun.Goal(run_id='p', checkpoint=path, spec=ONE, seed=9))
    assert (response.result.message, response.result.checkpoint) == ('', path)
    assert {'/body/twist', '/imu/data'} < seen[-1]
    assert '/joint_torques' not in seen[-1]
    agent = agent_file.load(path)
    env = HexapodLine('BC', agent.config)
    played = evaluate.run_episode(env, agent.policy, 9, 0)
    assert response.result.final_average_reward == played.episode_return


def test_a_goal_changes_the_specification_of_the_checkpoint(graph, path: str) -> None:
    results = []
    graph.nodes[0].create_subscription(EpisodeResult, 'episode_result', results.append, 10)
    graph.add(SimNode(), CpgNode(), AgentNode())
    spec = '{task: {time_limit_steps: 50}, training: {episodes: 1}}'
    goal = TrainRun.Goal(run_id='p', checkpoint=path, spec=spec)
    assert graph.train(goal).result.message == ''
    graph.until(lambda: bool(results))
    assert results[0].steps == 50


@pytest.mark.parametrize(
    ('change', 'complaint'),
    [
        ({'spec': 'observations: BD'}, "observes 'BC', expected the same or none"),
        ({'spec': 'task: {colour: 1}'}, "spec: unknown key 'task.colour'"),
        ({'checkpoint': '/no/such.pt'}, "checkpoint '/no/such.pt': not below"),
        ({'checkpoint': 'TMP/none.pt'}, "none.pt' not found, expected a file"),
    ],
)
def test_a_wrong_goal_ends_with_one_clear_error(
    graph, path, tmp_path, change, complaint: str
) -> None:
    graph.add(AgentNode())
    goal = TrainRun.Goal(run_id='p', checkpoint=path, spec=ONE)
    for name, value in change.items():
        setattr(goal, name, value.replace('TMP', str(tmp_path)))
    assert complaint in graph.train(goal).result.message
