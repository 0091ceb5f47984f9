# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A short training already steers, by each configuration; minutes, so run on demand."""

from importlib.resources import files

import numpy as np
import pytest
from hexapod_agent.algorithms.policies import Policy, constant_policy
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.environment.evaluation import Evaluation, run_episode, summarize
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.train import train_episode

STARTS = 10


def evaluate(env: HexapodLine, policy: Policy) -> Evaluation:
    return summarize([run_episode(env, policy, 777, start) for start in range(STARTS)])


@pytest.mark.slow
@pytest.mark.timeout(3600)
@pytest.mark.parametrize(('name', 'episodes'), [('', 60), ('swift.yaml', 100)])
def test_short_training_steers_and_the_constant_action_does_not(name, episodes):
    config = RunSpec.load(files('hexapod_agent') / name if name else None)
    env = HexapodLine('ABCDE', config)
    trainer = Trainer(config.observing('ABCDE'), seed=1)
    summaries = [train_episode(env, trainer) for _ in range(episodes)]
    learned = evaluate(env, trainer.learner.policy())
    constant = evaluate(env, constant_policy(np.zeros(30, np.float32)))
    assert learned.mean_offset < 0.5 * constant.mean_offset
    assert learned.final_average_reward > constant.final_average_reward
    assert learned.falls == 0
    assert np.mean([summary.metrics['saturated_share'] for summary in summaries[-10:]]) < 0.1
