# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""TD3, SAC and PPO train on the graph as in the environment, to the last bit."""

from __future__ import annotations

import pytest
import torch
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning.training import Trainer
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.train import evaluate, train_episode
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_interfaces.action import TrainRun
from hexapod_sim.nodes.sim_node import SimNode

pytestmark = pytest.mark.graph
SEED, EPISODES = 7, 3
GROUPS = '{batch_size: 32, buffer_size: 5000, update_every: 8, update_ratio: 0.5}'
SECTIONS = {'td3': GROUPS, 'sac': GROUPS, 'ppo': '{rollout_steps: 50, batch_size: 25}'}


@pytest.mark.parametrize('algorithm', SECTIONS)
def test_composed_worker_equals_environment(graph, algorithm: str) -> None:
    spec = RunSpec.from_text(
        f'observations: ABCDE\ntask: {{time_limit_steps: 40}}\n'
        f'learner: {{algorithm: {algorithm}, {algorithm}: {SECTIONS[algorithm]}}}\n'
        f'training: {{episodes: {EPISODES}, evaluation: 1, final_rate: 0.5}}\n',
        'a test',
    )
    alone, env = Trainer(spec, SEED), HexapodLine(config=spec)
    for _ in range(EPISODES):
        summary = train_episode(env, alone)
    assert summary.metrics['updates'] > 0
    *_, judged = evaluate(env, alone)
    trainers: list[Trainer] = []

    def make_trainer(config: RunSpec, seed: int) -> Trainer:
        trainers.append(Trainer(config, seed))
        return trainers[-1]

    graph.add(SimNode(), CpgNode(), AgentNode(make_trainer))
    goal = TrainRun.Goal(run_id=algorithm, spec=spec.to_text(), seed=SEED)
    response = graph.train(goal).result
    assert response.message == ''
    (trainer,) = trainers
    assert trainer.returns == alone.returns
    assert repr(trainer.summary) == repr(summary)
    assert response.evaluation_return == judged.average_return
    mine, its = (each.learner.state_dict()['model']['parameters'] for each in (alone, trainer))
    for key, value in mine['policy'].items():
        assert torch.equal(value, its['policy'][key]), key
