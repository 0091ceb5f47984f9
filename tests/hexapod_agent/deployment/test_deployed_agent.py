# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A deployed agent acts as in its evaluation, and remembers what it did."""

from __future__ import annotations

import numpy as np
import pytest
from hexapod_agent.deployment import agent_file
from hexapod_agent.deployment.deployed_agent import DeployedAgent
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.observation import ObservationError, ObservationSpec
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_cpg.mapping import ACTION_SIZE, COMMAND_FIELDS, ActionRanges, command_from_action

RANGES = ActionRanges.of_article()

SMALL = {'actor': {'hidden': [16, 12]}, 'critic': {'hidden': [16, 12]}}


@pytest.fixture
def path(tmp_path) -> str:
    trainer = Trainer(RunSpec.from_mapping(SMALL, 'small').observing('E'), 5)
    trainer.learner.networks.actor_parameters.flat.mul_(4.0)
    checkpoint.save_agent(tmp_path / 'agent.pt', trainer)
    return str(tmp_path / 'agent.pt')


def readings(spec: ObservationSpec, seed: int) -> dict[str, np.ndarray]:
    generator = np.random.default_rng(seed)
    return {key: generator.uniform(-0.5, 0.5, spec.sizes[key]) for key in spec.readings}


def test_it_acts_as_the_policy_on_readings_and_its_last_action(path: str) -> None:
    agent = DeployedAgent.load(path)
    policy = agent_file.load(path).policy
    action = np.zeros(ACTION_SIZE, dtype=np.float32)
    for seed in range(3):
        seen = readings(agent.spec, seed)
        action = policy(agent.spec.assemble(seen, action))
        expected = command_from_action(action, 'D1', RANGES)
        given = agent.act(seen)
        for field in COMMAND_FIELDS:
            np.testing.assert_array_equal(getattr(given, field), getattr(expected, field))
    assert action.any()


def test_a_reading_of_no_use_is_named_and_forgotten(path: str) -> None:
    agent, other = DeployedAgent.load(path), DeployedAgent.load(path)
    bad = readings(agent.spec, 1) | {'height': np.array([np.nan])}
    with pytest.raises(ObservationError, match=r"'body height': height\[0\] is nan"):
        agent.act(bad)
    good = readings(agent.spec, 2)
    np.testing.assert_array_equal(agent.act(good).hip_gain, other.act(good).hip_gain)


def test_a_file_changes_the_checkpoints_configuration(path: str, tmp_path) -> None:
    (tmp_path / 'change.yaml').write_text('cpg: {hopf: {gait: wave}}\n')
    assert DeployedAgent.load(path).config.cpg.hopf.gait == 'tripod'
    changed = DeployedAgent.load(path, str(tmp_path / 'change.yaml'))
    assert changed.config.cpg.hopf.gait == 'wave'
