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
from hexapod_agent.environment.evaluation import Episode, EpisodeMeter, run_episode, summarize
from hexapod_agent.learning import checkpoint

from hexapod_agent import evaluate


def test_figures_by_hand():
    episodes = [
        # 400 steps of 25 ms; the offset is judged over the last 200 only.
        Episode(10.0, np.repeat([0.5, -0.1], 200), 2.0, 30.0, False, 0.25),
        Episode(20.0, np.full(100, 0.3), 0.5, 20.0, True, 0.15),
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
    assert result.late_speed == pytest.approx(0.2)
    assert result.recovered is None
    assert summarize(episodes, undamaged_speed=0.4).recovered == 1  # at half of it, and no fall
    assert summarize(episodes, undamaged_speed=0.6).recovered == 0


def test_the_late_speed_is_that_of_the_last_eight_seconds():
    meter = EpisodeMeter(0.0)
    for step in range(1, 601):  # 280 steps to 1 m, 320 to 3 m
        x = step / 280 if step <= 280 else 1.0 + (step - 280) / 160
        meter.add(0.0, 0.0, x, np.zeros(18), np.zeros(18))
    assert meter.episode(fell=False).late_speed == pytest.approx(2.0 / 8.0)
    short = EpisodeMeter(1.0)
    short.add(0.0, 0.0, 1.5, np.zeros(18), np.zeros(18))
    assert short.episode(fell=True).late_speed == pytest.approx(0.5 / 0.025)


def test_robot_that_gets_nowhere_has_no_energy_per_metre():
    result = summarize([Episode(1.0, np.zeros(10), 0.0, 5.0, False, 0.0)])
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


def test_a_table_of_agents_and_cells(make_trainer, tmp_path, capsys):
    """What `evaluate` finds for one agent in one cell alone, in each row of its table."""
    agents = [tmp_path / 'a.pt', tmp_path / 'b.pt']
    for seed, agent in enumerate(agents):
        checkpoint.save_agent(agent, make_trainer(seed=seed))
    json_file = tmp_path / 'table.json'
    common = ['--starts', '2', '--set', 'task.time_limit_steps=30', '--json', str(json_file)]
    cells = ['--cell', '', '--cell', 'robot.dead_legs=lf+rr,robot.fault_time=0.25']
    grid = ['--grid', 'scene.name=rough', '--grid', 'scene.roughness=0,0.05']
    evaluate.main([*map(str, agents), *common, *cells, *grid])
    capsys.readouterr()
    rows = json.loads(json_file.read_text())
    assert [
        (row['agent'], row.get('robot.dead_legs'), row['scene.roughness']) for row in rows
    ] == [
        (str(agent), legs, roughness)
        for agent in agents
        for legs in (None, 'lf+rr')
        for roughness in (0, 0.05)
    ]
    assert [row['recovered'] is None for row in rows] == [True, True, False, False] * 2
    settings = ('robot.dead_legs=lf+rr', 'robot.fault_time=0.25', 'scene.name=rough')
    alone = [
        part for setting in (*settings, 'scene.roughness=0.05') for part in ('--set', setting)
    ]
    evaluate.main([str(agents[1]), *common, *alone])
    figures = json.loads(json_file.read_text())
    assert {key: rows[-1][key] for key in figures} == figures
    assert 'recovered' in capsys.readouterr().out


@pytest.mark.parametrize(
    ('options', 'complaint'),
    [
        (['--set', 'learner.actor.l2=0'], 'learner.actor.l2: a CHECKPOINT is as it was trained'),
        (['--grid', 'observations.A=on'], 'observations.A: a CHECKPOINT is as it was trained'),
        (['--grid', 'scene.roughness'], '--grid scene.roughness: expected KEY=VALUE,VALUE'),
        (['--cell', 'scene.name'], '--cell scene.name: expected KEY=VALUE,KEY=VALUE'),
        (['--grid', 'scene.name=flat,moon'], "scene.name=moon: scene.name is 'moon'"),
        (['--cell', 'scene.slope=1'], "scene.slope=1: unknown key 'scene.slope', expected one of"),
    ],
)
def test_cells_that_cannot_be_are_one_line(make_trainer, tmp_path, capsys, options, complaint):
    checkpoint.save_agent(tmp_path / 'a.pt', make_trainer())
    with pytest.raises(SystemExit) as ended:
        evaluate.main([str(tmp_path / 'a.pt'), '--starts', '1', *options])
    assert ended.value.code == 2
    assert complaint in capsys.readouterr().err


def test_evaluating_in_the_environment_needs_no_ros():
    code = 'import sys, hexapod_agent.evaluate; assert "rclpy" not in sys.modules'
    subprocess.run([sys.executable, '-c', code], check=True)
