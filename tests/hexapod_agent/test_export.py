# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""An exported policy acts as its checkpoint does, and says what to feed it."""

import json

import numpy as np
import onnx
import onnxruntime
import pytest
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning import checkpoint
from hexapod_sim.sensor_table import CHANNELS, LETTERS, PREVIOUS_ACTION

from hexapod_agent import export

# Sums of at most 126 products in float32 and in another order: some ulp (6e-8) of numbers of
# about 10 in the hidden layers.
TOLERANCE = 1e-5


@pytest.fixture(params=['', 'BC', LETTERS])
def trainer(make_trainer, request):
    made = make_trainer(request.param)
    made.learner.networks.actor_parameters.flat.mul_(8.0)  # actions of every size, also saturated
    return made


@pytest.fixture
def session(trainer, tmp_path):
    checkpoint.save_agent(tmp_path / 'agent.pt', trainer)
    export.main([str(tmp_path / 'agent.pt'), str(tmp_path / 'agent.onnx')])
    return onnxruntime.InferenceSession(
        tmp_path / 'agent.onnx', providers=['CPUExecutionProvider']
    )


def random_readings(spec, generator, count):
    """Return readings of both signs, some beyond the scale, and previous actions."""
    parts, start = {}, 0
    for key, size in spec.sizes.items():
        scale = spec.scale[start : start + size]
        parts[key] = generator.uniform(-1.5, 1.5, (count, size)) * scale
        start += size
    parts[PREVIOUS_ACTION] = parts[PREVIOUS_ACTION].clip(-1.0, 1.0)
    return parts


def test_actions_equal_the_checkpoints(trainer, session):
    parts = random_readings(trainer.spec, np.random.default_rng(0), 200)
    (actions,) = session.run(None, parts)
    policy = trainer.learner.policy()
    for row in range(200):
        one = {key: values[row] for key, values in parts.items()}
        expected = policy(trainer.spec.assemble(one, one[PREVIOUS_ACTION]))
        np.testing.assert_allclose(actions[row], expected, rtol=0.0, atol=TOLERANCE)
    assert np.abs(actions).max() > 0.9
    assert actions.std(axis=0).min() > 1e-3  # the readings decide


def test_it_drives_the_robot_from_raw_readings(trainer, session):
    env = HexapodLine(trainer.spec.letters, trainer.config)
    policy = trainer.learner.policy()
    observation, _ = env.reset(seed=3)
    action = np.zeros(30, np.float32)
    for _ in range(20):
        raw = env.task.sensors.observe(trainer.spec.channels) | {
            'oscillator': np.concatenate((env.cpg.x, env.cpg.y)),
            'line_offset': np.array([env.task.line_offset]),
            PREVIOUS_ACTION: action.astype(np.float64),
        }
        (exported,) = session.run(None, {key: raw[key][None] for key in trainer.spec.sizes})
        action = policy(observation)
        np.testing.assert_allclose(exported[0], action, rtol=0.0, atol=TOLERANCE)
        observation, *_ = env.step(action)


def test_metadata_is_the_sensor_contract(trainer, session):
    held = session.get_modelmeta().custom_metadata_map
    contract = {key: json.loads(value) for key, value in held.items()}
    assert contract['observations'] == trainer.spec.letters
    assert contract['control_period_ns'] == 25_000_000
    assert contract['joints'][:3] == ['lf_hip', 'lf_knee', 'lf_ankle']
    assert contract['action']['ranges']['hip_gain'] == [0.25, 0.15]
    rows = contract['inputs']
    assert [(row['input'], row['size']) for row in rows] == list(trainer.spec.sizes.items())
    assert [(i.name, i.shape[1]) for i in session.get_inputs()] == list(trainer.spec.sizes.items())
    table = {channel.name: channel for channel in CHANNELS}
    for row in rows:
        channel = table[row['channel']]
        quantity = channel.quantities[channel.readings.index(row['input'])]
        assert row['topics'] == list(channel.topics)
        assert (row['unit'], row['scale']) == (quantity.unit, quantity.scale)


def test_file_is_valid_and_small(trainer, session, tmp_path):
    model = onnx.load(tmp_path / 'agent.onnx')
    onnx.checker.check_model(model, full_check=True)
    numbers = sum(w.size + b.size for w, b in trainer.learner.policy().layers)
    assert (tmp_path / 'agent.onnx').stat().st_size < 4 * numbers + 10_000


def test_a_missing_checkpoint_is_one_clear_error(tmp_path, capsys):
    with pytest.raises(SystemExit):
        export.main([str(tmp_path / 'no.pt'), str(tmp_path / 'a.onnx')])
    assert "no.pt' not found" in capsys.readouterr().err
