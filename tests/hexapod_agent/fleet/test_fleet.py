# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A fleet gives each run the numbers that it gets alone."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import torch
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.fleet.robots import Robots
from hexapod_agent.fleet.stacked import StackedLearners
from hexapod_agent.learning.training import TrainingDivergedError
from hexapod_agent.train import evaluate

RUNS = (('ABCDEFG', 3), ('', 4), ('BC', 5))


def assert_same_state(one, other) -> None:
    """Compare everything that a checkpoint holds, to the last bit."""
    ours, theirs = (run.trainer.state_dict() for run in (one, other))
    assert_equal(ours, theirs)


def assert_equal(ours, theirs) -> None:
    assert type(ours) is type(theirs)
    if isinstance(ours, dict):
        assert ours.keys() == theirs.keys()
        for key in ours:
            assert_equal(ours[key], theirs[key])
    elif isinstance(ours, list):
        for mine, other in zip(ours, theirs, strict=True):
            assert_equal(mine, other)
    elif isinstance(ours, torch.Tensor):
        assert torch.equal(ours, theirs)
    else:
        np.testing.assert_array_equal(ours, theirs)


def assert_same_results(one, other) -> None:
    assert len(one.summaries) == len(other.summaries) == one.episodes
    for ours, theirs in zip(one.summaries, other.summaries, strict=True):
        assert_equal(vars(ours), vars(theirs))
    assert_same_evaluation(one, other)


def assert_same_evaluation(one, other) -> None:
    assert len(one.evaluation) == one.trainer.config.training.evaluation > 0
    for ours, theirs in zip(one.evaluation, other.evaluation, strict=True):
        assert_equal(vars(ours), vars(theirs))


@pytest.mark.parametrize('threads', [1, 3])
def test_runs_equal_those_trained_alone_to_the_last_bit(
    full_config, new_run, train_alone, train_fleet, threads
):
    fleet = [new_run(full_config, letters, seed) for letters, seed in RUNS]
    # Fewer slots than runs: the third run takes the slot that is free first.
    train_fleet(fleet, num_slots=2, threads=threads)
    for run, (letters, seed) in zip(fleet, RUNS, strict=True):
        alone = train_alone(new_run(full_config, letters, seed))
        assert run.end == 'ended'
        assert run.summaries[-1].metrics['updates'] > 0
        assert_same_results(run, alone)
        assert_same_state(run, alone)


def test_each_algorithm_learns_in_a_mixed_fleet_as_alone(
    library_configs, new_run, train_alone, train_fleet
):
    # Three algorithms on two threads, and two runs of one at a time.
    configs = [*library_configs, library_configs[1]]
    fleet = [new_run(config, 'ABCDE', seed) for seed, config in enumerate(configs)]
    train_fleet(fleet, num_slots=4, threads=2)
    for seed, (run, config) in enumerate(zip(fleet, configs, strict=True)):
        alone = train_alone(new_run(config, 'ABCDE', seed))
        assert run.end == 'ended'
        assert run.summaries[-1].metrics['updates'] > 0
        assert_same_results(run, alone)
        assert_same_state(run, alone)


def test_varied_robots_are_judged_in_a_fleet_as_they_are_alone(
    small_config, new_run, train_alone, train_fleet
):
    config = small_config.changed({'robot': {'dead_legs': 'lf', 'fault_time': 0.25}}, 'a test')
    fleet = [new_run(config, letters, seed) for letters, seed in RUNS]
    train_fleet(fleet, num_slots=2)
    for run, (letters, seed) in zip(fleet, RUNS, strict=True):
        assert_same_results(run, train_alone(new_run(config, letters, seed)))
        assert all(each.metrics['recovered'] in (0.0, 1.0) for each in run.evaluation)


def test_bad_sensors_are_as_bad_in_a_fleet(small_config, new_run, train_alone, train_fleet):
    bad = {
        'imu_data': {'noise': 0.05, 'bias': 0.1, 'delay': 0.05, 'dropout': 0.3, 'rate': 20.0},
        'line_offset': {'bias': 0.1},
        'foot_force': {'noise': 1.0, 'dropout': 0.3},
    }
    config = small_config.changed({'sensors': bad}, 'a test')
    fleet = [new_run(config, letters, seed) for letters, seed in RUNS]
    train_fleet(fleet, num_slots=2)
    for run, (letters, seed) in zip(fleet, RUNS, strict=True):
        assert_same_results(run, train_alone(new_run(config, letters, seed)))
    perfect = train_alone(new_run(small_config, *RUNS[0]))
    assert fleet[0].summaries[0].episode_return != perfect.summaries[0].episode_return


def test_runs_of_other_specifications_equal_those_trained_alone(
    small_config, new_run, train_alone, train_fleet
):
    settings = (
        [],
        ['cpg.hopf.gait=wave', 'task.closeness_weight=0'],
        ['cpg.ranges.hip_gain=[0.2, 0.1]', 'learner.actor.hidden=[8]', 'task.line_y=0.3'],
        ['task.time_limit_steps=30', 'learner.ddpg.n_step=3', 'learner.actor.learning_rate=1e-3'],
    )
    configs = [small_config.with_settings(each) for each in settings]
    fleet = [new_run(config, 'CE', seed) for seed, config in enumerate(configs)]
    train_fleet(fleet, num_slots=2)
    for seed, (run, config) in enumerate(zip(fleet, configs, strict=True)):
        alone = train_alone(new_run(config, 'CE', seed))
        assert run.end == 'ended'
        assert_same_results(run, alone)
        assert_same_state(run, alone)
    assert len({run.summaries[0].episode_return for run in fleet}) == len(fleet)


def test_another_algorithm_learns_in_a_fleet_what_it_learns_alone(
    search, new_run, train_alone, train_fleet
):
    fleet, alone = ([new_run(search, 'B', seed) for seed in (1, 2)] for _ in range(2))
    train_fleet(fleet, num_slots=2)
    for ours, theirs in zip(fleet, alone, strict=True):
        assert_same_results(ours, train_alone(theirs))


@pytest.mark.parametrize('name', ['small_config', 'switched_config'])
def test_a_stack_learns_what_its_runs_learn_alone(
    name, request, new_run, train_alone, train_fleet
):
    config = request.getfixturevalue(name)
    stacked = [new_run(config, letters, seed) for letters, seed in RUNS]
    train_fleet(stacked, num_slots=2, stacked=True)
    for run, (letters, seed) in zip(stacked, RUNS, strict=True):
        alone = train_alone(new_run(config, letters, seed))
        # Sums are rounded otherwise, and small differences grow from step to step.
        for ours, theirs in zip(run.summaries, alone.summaries, strict=True):
            assert ours.episode_return == pytest.approx(theirs.episode_return, rel=1e-3)
            assert ours.metrics['updates'] == theirs.metrics['updates']
        env = HexapodLine(config=run.trainer.config)
        run_alone = SimpleNamespace(evaluation=list(evaluate(env, run.trainer)))
        assert_same_evaluation(run, run_alone)  # of what it learned, to the last bit
        for name, array in alone.trainer.learner.networks.actor_parameters.arrays.items():
            ours = run.trainer.learner.networks.actor_parameters.arrays[name]
            torch.testing.assert_close(ours, array, rtol=1e-2, atol=1e-3)


def test_agents_of_a_stack_learn_at_once_after_one_of_them_fell(
    small_config, new_run, train_fleet, monkeypatch
):
    runs = [new_run(small_config, '', seed) for seed in (1, 2)]
    advance, collect = Robots.advance, StackedLearners.collect
    learning = []

    def advance_to_a_fall(robots, slot):
        outcome = advance(robots, slot)
        falls = outcome.step == 5 and slot == 0 and not runs[0].summaries
        return replace(outcome, terminated=True, cause='fell') if falls else outcome

    def counted_collect(learners):
        stack = learners._stack
        if stack._pending:
            learning.append((len(stack._learning), len(stack._pending)))
        collect(learners)

    monkeypatch.setattr(Robots, 'advance', advance_to_a_fall)
    monkeypatch.setattr(StackedLearners, 'collect', counted_collect)
    train_fleet(runs, num_slots=2, stacked=True)
    assert [run.summaries[0].steps for run in runs] == [5, 40]
    # A batch is 16. The robot that fell begins again with the next group of 8: after 24 periods
    # the other has 23 transitions and it has 20. It is through after 48, the other after 80.
    assert learning == [(2, 8)] * 4 + [(1, 8)] * 4


def test_a_run_that_diverges_leaves_the_others_alone(
    small_config, new_run, train_alone, train_fleet
):
    runs = [new_run(small_config, 'B', seed) for seed in (1, 2)]
    runs[0].trainer.learner.networks.critic_parameters.flat.fill_(float('inf'))
    train_fleet(runs, num_slots=2)
    assert isinstance(runs[0].end, TrainingDivergedError)
    assert_same_results(runs[1], train_alone(new_run(small_config, 'B', 2)))


@pytest.mark.filterwarnings('ignore:overflow encountered', 'ignore:invalid value')
def test_a_pattern_generator_that_breaks_down_leaves_other_ones_alone(
    small_config, new_run, train_alone, train_fleet
):
    wild = small_config.with_settings(['cpg.ranges.mu=[1e200, 0]'])
    runs = [new_run(config, 'B', 2) for config in (wild, small_config)]
    train_fleet(runs, num_slots=2)
    assert 'expected values that the integration can follow' in str(runs[0].end)
    assert_same_results(runs[1], train_alone(new_run(small_config, 'B', 2)))


def test_a_fleet_counts_steps_and_the_parts_of_its_time(small_config, new_run, train_fleet):
    runs = [new_run(small_config, '', seed, episodes=2) for seed in (1, 2)]
    fleet = train_fleet(runs, num_slots=2)
    had = (summary for run in runs for summary in (*run.summaries, *run.evaluation))
    assert fleet.steps == sum(summary.steps for summary in had)
    shares = fleet.stopwatch.shares()
    assert list(shares) == ['physics', 'cpg', 'learner', 'rest']
    assert sum(shares.values()) == pytest.approx(1.0)
    assert all(0.0 < share < 1.0 for share in shares.values())
