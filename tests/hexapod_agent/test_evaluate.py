# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The figures of an evaluation by hand, and the command line around them."""

import json
import subprocess
import sys

import numpy as np
import pytest
from hexapod_agent.algorithms.policies import (
    constant_policy,
    random_policy,
)
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.environment.evaluation import Episode, run_episode, summarize
from hexapod_agent.learning import checkpoint

from hexapod_agent import evaluate


def test_figures_by_hand():
    episodes = [
        # 400 steps of 25 ms; the offset is judged over the last 200 only.
        Episode(10.0, np.repeat([0.5, -0.1], 200), 2.0, 30.0, False),
        Episode(20.0, np.full(100, 0.3), 0.5, 20.0, True),
    ]
    result = summarize(episodes)
    assert result.starts == 2
    assert result.final_average_reward == 15.0
    assert result.return_deviation == 5.0
    assert result.mean_offset == pytest.approx((200 * 0.1 + 100 * 0.3) / 300)
    assert result.offset_95 == pytest.approx(0.3)
    assert result.speed == pytest.approx(2.5 / 12.5)
    assert result.falls == 1
    assert result.energy_per_metre == pytest.approx(50.0 / 2.5)


def test_robot_that_gets_nowhere_has_no_energy_per_metre():
    result = summarize([Episode(1.0, np.zeros(10), 0.0, 5.0, False)])
    assert np.isnan(result.energy_per_metre)


def test_constant_walk_goes_forward(small_config):
    episode = run_episode(HexapodLine('', small_config), constant_policy(np.zeros(30)), 1, 0)
    assert episode.offsets.shape == (40,)
    assert episode.distance > 0.05
    assert episode.energy > 0.0
    assert not episode.fell


def test_baselines_and_trained_policy_repeat(make_trainer):
    seen = np.zeros(make_trainer().spec.size, np.float32)
    np.testing.assert_array_equal(random_policy(3)(seen), random_policy(3)(seen))
    policy = make_trainer().learner.policy()
    np.testing.assert_array_equal(policy(seen), policy(seen))
    assert policy(seen).shape == (30,)


def test_command_line_of_a_checkpoint(make_trainer, tmp_path, capsys):
    checkpoint.save_agent(tmp_path / 'a.pt', make_trainer())
    json_file = tmp_path / 'a.json'
    arguments = [str(tmp_path / 'a.pt'), '--starts', '2', '--json', str(json_file)]
    evaluate.main(arguments)
    first = json.loads(json_file.read_text())
    evaluate.main(arguments)
    assert json.loads(json_file.read_text()) == first
    assert first['starts'] == 2
    assert f'{first["final_average_reward"]:.1f}' in capsys.readouterr().out


def test_command_line_wants_one_subject(capsys):
    with pytest.raises(SystemExit):
        evaluate.main([])
    assert 'expected either a CHECKPOINT or --policy' in capsys.readouterr().err


def test_command_line_plays_no_baseline_on_the_graph(capsys):
    with pytest.raises(SystemExit):
        evaluate.main(['--policy', 'zero', '--graph'])
    assert '--graph: expected a CHECKPOINT' in capsys.readouterr().err


def test_figures_are_not_measured_by_bad_sensors(make_trainer, small_config, tmp_path, capsys):
    config = small_config.with_value('sensors.line_offset.noise', 0.01, 'a test')
    trainer = make_trainer(config=config)
    checkpoint.save_agent(tmp_path / 'a.pt', trainer)
    with pytest.raises(SystemExit):
        evaluate.main([str(tmp_path / 'a.pt'), '--graph'])
    assert 'measured by the topics of line_offset, whose errors' in capsys.readouterr().err


def test_evaluating_in_the_environment_needs_no_ros():
    code = 'import sys, hexapod_agent.evaluate; assert "rclpy" not in sys.modules'
    subprocess.run([sys.executable, '-c', code], check=True)
