# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The command line `run_fleet`: a campaign's bags, going on after a crash, and what it refuses."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import yaml
from hexapod_agent.deployment import agent_file
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning import run_checkpoint
from hexapod_agent.learning.training import Trainer, TrainingDivergedError
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.train import train_episode
from hexapod_doe.bags.run_record import find_bags, read_run
from hexapod_doe.bags.verify import digest, verify
from hexapod_doe.campaigns.campaign import Campaign
from hexapod_doe.campaigns.campaign_lock import campaign_lock, row_lock
from hexapod_doe.campaigns.failures import read_failures
from hexapod_doe.campaigns.plan_copy import place_plan

from hexapod_doe import plan, run_fleet

EPISODES = 5
SMALL = {
    'task': {'time_limit_steps': 40},
    'actor': {'hidden': [16, 12]},
    'critic': {'hidden': [16, 12]},
    'ddpg': {'batch_size': 16, 'buffer_size': 5000, 'update_every': 8},
    'training': {'evaluation': 2, 'checkpoint_every': 2, 'window': 2},
}


@pytest.fixture(scope='module')
def hyperparameters(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp('fleet') / 'small.yaml'
    path.write_text(yaml.safe_dump(SMALL))
    return path


@pytest.fixture(scope='module')
def plan_file(hyperparameters) -> Path:
    """Four rows: half a factorial of three sensors."""
    path = hyperparameters.with_name('plan.csv')
    make = ['--generators', 'C=AB', '--factors', 'ABC', '--replicates', '1', '--seed', '1']
    plan.main([*make, '--out', str(path)])
    return path


@pytest.fixture
def arguments(hyperparameters, plan_file):
    def make(out: Path, **options: object) -> list[str]:
        given = {'plan': plan_file, 'out': out, 'config': hyperparameters}
        given |= {'episodes': EPISODES, 'processes': 1, 'threads': 2} | options
        return [text for name, value in given.items() for text in (f'--{name}', str(value))]

    return make


@pytest.fixture(scope='module')
def digests(tmp_path_factory, hyperparameters, plan_file) -> dict[str, str]:
    """Digest of each bag of the undisturbed campaign, by run."""
    out = tmp_path_factory.mktemp('whole')
    options = ['--episodes', str(EPISODES), '--config', str(hyperparameters), '--processes', '1']
    assert run_fleet.main(['--plan', str(plan_file), '--out', str(out), *options]) == 0
    return campaign_digests(out)


def campaign_digests(directory: Path) -> dict[str, str]:
    return {bag.name: digest(bag) for bag in find_bags(directory)}


def test_rows_equal_those_trained_alone(arguments, hyperparameters, tmp_path):
    assert run_fleet.main(arguments(tmp_path, slots=3)) == 0
    config = RunSpec.load(hyperparameters)
    rows = Campaign.open(tmp_path / 'plan.csv').rows
    assert len(rows) == 4
    for row in rows:
        trainer = Trainer(config.observing(row.observations), row.seed)
        env = HexapodLine(row.observations, config)
        alone = [train_episode(env, trainer) for _ in range(EPISODES)]
        verify(row.bag)
        record = read_run(row.bag)
        assert record.metadata['observations'] == row.observations
        assert record.metadata['case'] == row.metadata['case']
        for name in ('episode_return', 'steps'):
            expected = [getattr(summary, name) for summary in alone]
            np.testing.assert_array_equal(record.episodes[name], expected)
        for name in ('critic_loss', 'mean_q', 'updates'):
            expected = [summary.metrics[name] for summary in alone]
            np.testing.assert_array_equal(record.episodes[name], expected)
        agent = agent_file.load(row.bag.parent / record.metadata['checkpoint'])
        for ours, alone in zip(agent.policy.layers, trainer.learner.policy().layers, strict=True):
            np.testing.assert_array_equal(ours[0], alone[0])
            np.testing.assert_array_equal(ours[1], alone[1])


@pytest.mark.parametrize('slots', [1, 4])
def test_bags_do_not_depend_on_the_number_of_slots(arguments, digests, tmp_path, slots):
    assert run_fleet.main(arguments(tmp_path, slots=slots, threads=slots)) == 0
    assert campaign_digests(tmp_path) == digests


def test_a_stack_fills_the_same_campaign(arguments, tmp_path, monkeypatch):
    # No accelerator is needed to compute as on one.
    monkeypatch.setattr(run_fleet, 'is_cpu', lambda device: False)
    assert run_fleet.main(arguments(tmp_path)) == 0
    for bag in find_bags(tmp_path):
        verify(bag)
        assert len(read_run(bag).episodes) == EPISODES


def test_runs_learn_side_by_side_that_learn_alike():
    base = RunSpec.load()
    specs = {
        'a': base,
        'b': base.with_settings(['task.line_y=0.1', 'observations=ABC', 'cpg.hopf.gait=wave']),
        'c': base.with_settings(['learner.actor.learning_rate=1e-3']),
        'd': base.with_settings(['training.precision=float32']),
    }
    assert run_fleet.learning_alike(specs, 'cpu') == [['a', 'b', 'c'], ['d']]
    assert run_fleet.learning_alike(specs, 'meta') == [['a', 'b'], ['c'], ['d']]


def test_stacks_of_other_learners_follow_one_another(hyperparameters, tmp_path, monkeypatch):
    (tmp_path / 'factors.yaml').write_text(
        '- {name: observing, key: observations.C, low: off, high: on}\n'
        '- {name: layers, key: learner.actor.hidden, low: [8], high: [16, 8]}\n'
    )
    made = ['--factors', str(tmp_path / 'factors.yaml'), '--design', 'full', '--replicates', '1']
    plan.main([*made, '--config', str(hyperparameters), '--out', str(tmp_path / 'plan.csv')])
    monkeypatch.setattr(run_fleet, 'is_cpu', lambda device: False)
    given = ['--plan', str(tmp_path / 'plan.csv'), '--episodes', '1', '--processes', '1']
    assert run_fleet.main(given) == 0
    for row in Campaign.open(tmp_path / 'plan.csv').rows:
        kept = agent_file.load(f'{row.bag}.pt').config
        assert kept == row.spec.with_value('training.episodes', 1, 'test')


def test_processes_on_a_device_share_out_rows_and_cores(arguments, tmp_path, monkeypatch):
    started = []
    monkeypatch.setattr(run_fleet, 'is_cpu', lambda device: False)
    monkeypatch.setattr(run_fleet, '_CORES', 7)
    monkeypatch.setattr(
        run_fleet, 'train_in_processes', lambda *given: started.append(given) or []
    )
    given = arguments(tmp_path, processes=3)
    at = given.index('--threads')
    assert run_fleet.main([*given[:at], *given[at + 2 :]]) == 1
    ((directory, count, options),) = started
    assert (directory, count) == (tmp_path, 3)
    assert options[options.index('--slots') + 1] == '2'  # of 4 rows
    assert options[options.index('--threads') + 1] == '2'


def test_killed_fleet_goes_on_to_the_same_bags(arguments, digests, tmp_path):
    given = arguments(tmp_path, slots=2)
    process = subprocess.Popen([sys.executable, '-m', 'hexapod_doe.run_fleet', *given])
    # It dies in the middle of what follows its first checkpoint.
    while process.poll() is None and not list(tmp_path.glob('runs/*.checkpoint.pt')):
        time.sleep(0.01)
    process.kill()
    assert process.wait() == -signal.SIGKILL
    assert run_fleet.main(given) == 0
    assert campaign_digests(tmp_path) == digests
    resumed = [read_run(bag).metadata.get('resumed') for bag in find_bags(tmp_path)]
    assert any(resumed)
    assert not list(tmp_path.glob('runs/*.checkpoint.pt'))


def test_finished_campaign_is_left_as_it_is(arguments, tmp_path, capsys):
    assert run_fleet.main(arguments(tmp_path, episodes=1)) == 0
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob('*.mcap')}
    assert run_fleet.main(arguments(tmp_path, episodes=1)) == 0
    assert before == {path: path.stat().st_mtime_ns for path in tmp_path.rglob('*.mcap')}
    assert capsys.readouterr().out.endswith(f'4 of 4 runs are in {tmp_path}\n')


def test_another_plan_in_the_folder_is_refused(arguments, tmp_path, capsys):
    (tmp_path / 'plan.csv').write_text('another')
    assert run_fleet.main(arguments(tmp_path)) == 2
    assert 'another plan' in capsys.readouterr().err


def test_checkpoint_of_other_hyperparameters_is_no_beginning(arguments, digests, tmp_path, capsys):
    row = Campaign.open(place_plan(Path(arguments(tmp_path)[1]), tmp_path)).rows[0]
    trainer = Trainer(RunSpec.load().observing(row.observations), row.seed)
    run_checkpoint.keep(row.bag, trainer)
    assert run_fleet.main(arguments(tmp_path)) == 0
    assert f'run {row.run_id} begins anew' in capsys.readouterr().out
    assert campaign_digests(tmp_path) == digests


def test_row_with_a_damaged_checkpoint_begins_anew(
    arguments, hyperparameters, digests, tmp_path, capsys
):
    row = Campaign.open(place_plan(Path(arguments(tmp_path)[1]), tmp_path)).rows[0]
    config = RunSpec.load(hyperparameters)
    trainer = Trainer(config.observing(row.observations), row.seed)
    train_episode(HexapodLine(row.observations, config), trainer)
    run_checkpoint.keep(row.bag, trainer)
    path = run_checkpoint.checkpoint_path(row.bag)
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    assert run_fleet.main(arguments(tmp_path)) == 0
    printed = ' '.join(capsys.readouterr().out.split())
    assert f'run {row.run_id} begins anew: checkpoint' in printed
    assert 'is damaged' in printed
    assert campaign_digests(tmp_path) == digests


def test_row_of_another_process_is_left_to_it(arguments, tmp_path, capsys):
    row = Campaign.open(place_plan(Path(arguments(tmp_path)[1]), tmp_path)).rows[0]
    with campaign_lock(tmp_path, shared=True), row_lock(row.bag):
        assert run_fleet.main(arguments(tmp_path, episodes=1)) == 1
    printed = capsys.readouterr().out
    assert printed.count(f'{row.run_id} is left to the process') == 1
    assert '3 of 4 runs' in printed
    assert run_fleet.main(arguments(tmp_path, episodes=1)) == 0


def test_campaign_of_a_manager_is_refused(arguments, tmp_path, capsys):
    with campaign_lock(tmp_path):
        assert run_fleet.main(arguments(tmp_path)) == 2
    assert 'is at it' in capsys.readouterr().err


def test_failed_row_is_told_and_tried_again(arguments, tmp_path, monkeypatch):
    monkeypatch.setattr(Trainer, 'learn', diverge)
    assert run_fleet.main(arguments(tmp_path)) == 1
    reasons = read_failures(tmp_path)
    assert len(reasons) == 4
    assert all(why == ['the loss is nan'] for why in reasons.values())
    monkeypatch.undo()
    assert run_fleet.main(arguments(tmp_path, episodes=1)) == 0


def diverge(trainer: Trainer) -> None:
    raise TrainingDivergedError('the loss is nan')


def test_row_that_fails_is_tried_by_one_of_the_processes(arguments, tmp_path, capsys):
    settings = tmp_path / 'steep.yaml'
    settings.write_text(
        yaml.safe_dump(SMALL | {'critic': SMALL['critic'] | {'learning_rate': 1e6}})
    )
    assert run_fleet.main(arguments(tmp_path, processes=2, config=settings)) == 1
    reasons = read_failures(tmp_path)
    assert len(reasons) == 4
    told = capsys.readouterr().err
    for run_id, why in reasons.items():
        assert len(why) == 1
        assert f'{run_id} failed: {why[0]}' in told


def test_process_that_breaks_down_is_named_and_its_row_stays_due(arguments, digests, tmp_path):
    given = arguments(tmp_path, processes=2, threads=1)
    command = [sys.executable, '-m', 'hexapod_doe.run_fleet', *given]
    parent = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    while not bags_under_way(tmp_path):
        time.sleep(0.01)
    (first, *_) = children_of(parent.pid)
    os.kill(first, signal.SIGKILL)
    told = parent.communicate(timeout=120.0)[1]
    assert 'ended with status -9, see' in told
    assert run_fleet.main(arguments(tmp_path)) == 0
    assert campaign_digests(tmp_path) == digests


@pytest.mark.parametrize(
    'how', [signal.SIGTERM, pytest.param(signal.SIGINT, marks=pytest.mark.slow)]
)
def test_interrupted_processes_end_with_their_parent(arguments, tmp_path, how):
    given = arguments(tmp_path, processes=2, threads=1, episodes=10_000)
    parent = subprocess.Popen([sys.executable, '-m', 'hexapod_doe.run_fleet', *given])
    while len(bags_under_way(tmp_path)) < 2:
        time.sleep(0.01)
    children = children_of(parent.pid)
    assert len(children) == 2
    parent.send_signal(how)
    try:
        assert parent.wait(30.0) == 130
    finally:
        parent.kill()
    assert not any(Path(f'/proc/{child}').exists() for child in children)
    assert len(bags_under_way(tmp_path)) == 2


def bags_under_way(directory: Path) -> list[Path]:
    """Return the bags that are being written; a checkpoint is also `.partial` for a moment."""
    return [path for path in directory.glob('runs/*.partial') if path.is_dir()]


def children_of(process: int) -> list[int]:
    return [int(n) for n in Path(f'/proc/{process}/task/{process}/children').read_text().split()]


@pytest.mark.parametrize(
    ('options', 'message'),
    [
        ({'slots': 0}, 'expected at least 1'),
        ({'device': 'abacus'}, "'abacus' cannot be used"),
        ({'threads': 'many'}, 'threads'),
    ],
)
def test_wrong_options_are_one_clear_error(arguments, tmp_path, capsys, options, message):
    with pytest.raises(SystemExit):
        run_fleet.main(arguments(tmp_path, **options))
    assert message in capsys.readouterr().err
