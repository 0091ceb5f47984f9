# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The command line `train`: its files, resuming, and what it refuses."""

import csv
import re

import numpy as np
import pytest
import yaml
from hexapod_agent.deployment import agent_file
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.player import Player
from hexapod_agent.learning.training import Trainer
from hexapod_sim.task import LineTask

from hexapod_agent import train


@pytest.fixture
def config_file(small_config, tmp_path):
    path = tmp_path / 'small.yaml'
    mapping = small_config.to_mapping()
    mapping['training']['checkpoint_every'] = 2
    path.write_text(yaml.safe_dump(mapping))
    return path


def run(*arguments) -> None:
    train.main([str(argument) for argument in arguments])


def log(directory, name=train.LOG) -> list[dict[str, str]]:
    with (directory / name).open() as file:
        return list(csv.DictReader(file))


def test_run_leaves_log_and_checkpoints(config_file, tmp_path, capsys):
    out = tmp_path / 'run'
    run(
        '--observations', 'CB', '--seed', 2, '--episodes', 3, '--config', config_file, '--out', out
    )
    rows = log(out)
    assert [row['episode'] for row in rows] == ['0', '1', '2']
    terms = [float(value) for key, value in rows[1].items() if key.startswith('term_')]
    assert sum(terms) == pytest.approx(float(rows[1]['episode_return']))
    agent = agent_file.load(out / train.AGENT)
    assert (agent.spec.letters, agent.seed, agent.episode) == ('BC', 2, 3)
    printed = capsys.readouterr().out.replace('\n', '')
    average = checkpoint.load(out / train.CHECKPOINT).average_return
    assert f'final average reward {average:.1f}' in printed
    assert printed.endswith(f'evaluate {out / train.AGENT} --starts 50')


def test_resumed_log_is_the_uninterrupted_one(config_file, tmp_path):
    whole, part = tmp_path / 'whole', tmp_path / 'part'
    run('--episodes', 5, '--config', config_file, '--out', whole)
    run('--episodes', 3, '--config', config_file, '--out', part)
    run('--episodes', 5, '--out', part, '--resume')
    assert log(part) == log(whole)
    assert len(log(whole)) == 5


def test_an_evaluation_ends_the_run_and_changes_no_number_of_it(config_file, tmp_path, capsys):
    judged, plain = tmp_path / 'judged', tmp_path / 'plain'
    given = ('--config', config_file, '--episodes', 3)
    run(*given, '--out', judged)
    rows = log(judged, train.EVALUATION)
    returns = [float(row['episode_return']) for row in rows]
    assert len(returns) == 2
    assert float(rows[-1]['average_return']) == np.mean(returns)
    assert f'evaluation return {np.mean(returns):.1f}' in capsys.readouterr().out
    assert {row['updates'] for row in rows} == {'0.0'}
    run(*given, '--set', 'training.evaluation=0', '--out', plain)
    assert not (plain / train.EVALUATION).exists()
    assert log(plain) == log(judged)
    state = checkpoint.load(judged / train.CHECKPOINT).learner.state_dict()
    same = checkpoint.load(plain / train.CHECKPOINT).learner.state_dict()
    assert state['noise_generator'] == same['noise_generator']
    assert state['replay_generator'] == same['replay_generator']


def test_every_run_is_evaluated_from_the_same_starts(make_trainer, monkeypatch):
    seeds: list[int] = []
    reset = LineTask.reset

    def noted(task, seed):
        seeds.append(seed)
        return reset(task, seed)

    monkeypatch.setattr(LineTask, 'reset', noted)
    for seed, letters in ((5, 'BC'), (6, 'A')):
        trainer = make_trainer(letters, seed)
        list(train.evaluate(HexapodLine(config=trainer.config), trainer))
    assert seeds[:2] == seeds[2:]
    assert len(set(seeds)) == 2


def test_a_run_that_ends_amid_its_evaluation_gives_the_same(config_file, tmp_path, monkeypatch):
    whole, part = tmp_path / 'whole', tmp_path / 'part'
    given = ('--config', config_file, '--episodes', 3)
    run(*given, '--out', whole)

    def cut(self, observation, outcome):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(Player, 'end_episode', cut)
        with pytest.raises(SystemExit):
            run(*given, '--out', part)
    assert not (part / train.EVALUATION).exists()
    run('--episodes', 3, '--out', part, '--resume')
    for name in (train.LOG, train.EVALUATION):
        assert log(part, name) == log(whole, name)


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        (('--observations', 'ABX'), "unknown letter 'X'"),
        (
            ('--observations', 'D', '--set', 'observations=AB'),
            '--observations D and --set observations=AB: expected one of them',
        ),
        (('--config', 'no.yaml'), "'no.yaml' not found"),
        (('--resume',), 'checkpoint.*not found'),
        (('--episodes', 0), "--episodes: '0', expected a whole number from 1"),
        (('--episodes', -3), "--episodes: '-3', expected a whole number from 1"),
        (('--episodes', '2.5'), "--episodes: '2.5', expected a whole number from 1"),
        (('--seed', -1), "--seed: '-1', expected a whole number from 0"),
        (('--seed', 2**63), '--seed.*expected a whole number from 0'),
        (('--config', '~nobody-of-this-name/a.yaml'), '--config.*home directory'),
    ],
)
def test_wrong_arguments_are_one_clear_error(tmp_path, capsys, arguments, message):
    with pytest.raises(SystemExit) as stopped:
        run('--out', tmp_path / 'run', *arguments)
    assert stopped.value.code == 2
    assert re.search(message, capsys.readouterr().err)
    assert not (tmp_path / 'run').exists()


@pytest.mark.parametrize('out', ['file', 'file/run'])
def test_a_folder_that_cannot_be_made_is_one_clear_error(config_file, tmp_path, capsys, out):
    (tmp_path / 'file').write_text('something else')
    with pytest.raises(SystemExit) as stopped:
        run('--config', config_file, '--episodes', 1, '--out', tmp_path / out)
    assert stopped.value.code == 2
    assert str(tmp_path / out) in capsys.readouterr().err


def test_the_home_folder_is_known(config_file, tmp_path, monkeypatch):
    monkeypatch.setenv('HOME', str(tmp_path))
    run('--config', '~/small.yaml', '--episodes', 1, '--out', '~/runs/a')
    assert (tmp_path / 'runs' / 'a' / train.AGENT).exists()


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        (('--observations', 'ABCDE'), "observations is 'ABCDE' here, 'BC' there"),
        (('--seed', 9), 'seed is 9 here, 1 there'),
        (('--config', 'other'), r'learner\.ddpg\.discount is 0\.9 here, 0\.99 there'),
        (
            ('--config', 'other', '--seed', 9, '--observations', 'A'),
            "observations is 'A' here, 'BC' there; seed is 9 here, 1 there; learner.ddpg.discount",
        ),
        (('--episodes', 1), '--episodes is 1, but the run .* has had 2, expected at least as'),
    ],
)
def test_a_resumed_run_stays_the_run_that_it_is(config_file, tmp_path, capsys, arguments, message):
    out = tmp_path / 'run'
    run('--observations', 'BC', '--episodes', 2, '--config', config_file, '--out', out)
    before = {path.name: path.read_bytes() for path in out.iterdir() if path.is_file()}
    mapping = yaml.safe_load(config_file.read_text())
    mapping.setdefault('learner', {}).setdefault('ddpg', {})['discount'] = 0.9
    other = tmp_path / 'other.yaml'
    other.write_text(yaml.safe_dump(mapping))
    with pytest.raises(SystemExit) as stopped:
        run('--resume', '--out', out, *(other if each == 'other' else each for each in arguments))
    assert stopped.value.code == 2
    assert re.search(message, capsys.readouterr().err)
    assert before == {path.name: path.read_bytes() for path in out.iterdir() if path.is_file()}


def test_the_same_options_may_be_given_again(config_file, tmp_path):
    whole, part = tmp_path / 'whole', tmp_path / 'part'
    options = ['--observations', 'CB', '--seed', 3, '--config', config_file]
    run(*options, '--episodes', 3, '--out', whole)
    run(*options, '--episodes', 2, '--out', part)
    run(*options, '--episodes', 3, '--out', part, '--resume')
    assert log(part) == log(whole)


def test_a_run_goes_on_without_its_log(config_file, tmp_path):
    out = tmp_path / 'run'
    run('--episodes', 2, '--config', config_file, '--out', out)
    (out / train.LOG).unlink()
    run('--episodes', 3, '--out', out, '--resume')
    assert [row['episode'] for row in log(out)] == ['2']


def test_a_damaged_checkpoint_is_refused_by_name(config_file, tmp_path, capsys):
    out = tmp_path / 'run'
    run('--episodes', 1, '--config', config_file, '--out', out)
    content = bytearray((out / train.CHECKPOINT).read_bytes())
    content[len(content) // 2] ^= 1
    (out / train.CHECKPOINT).write_bytes(content)
    with pytest.raises(SystemExit) as stopped:
        run('--episodes', 2, '--out', out, '--resume')
    assert stopped.value.code == 2
    assert re.search(r'checkpoint.pt.*is damaged', capsys.readouterr().err)


def test_finished_run_is_not_overwritten(config_file, tmp_path, capsys):
    run('--episodes', 1, '--config', config_file, '--out', tmp_path / 'run')
    with pytest.raises(SystemExit):
        run('--episodes', 1, '--config', config_file, '--out', tmp_path / 'run')
    assert 'expected --resume or another --out' in capsys.readouterr().err


def test_divergence_is_named_and_leaves_the_checkpoint_before_it(
    config_file, tmp_path, monkeypatch
):
    whole, part = tmp_path / 'whole', tmp_path / 'part'
    run('--episodes', 4, '--config', config_file, '--out', whole)

    def observe(trainer, observation, outcome):
        if trainer.episode == 3 and outcome.step == 2:
            observation = np.full_like(observation, np.nan)
        return usual(trainer, observation, outcome)

    usual = Trainer.observe
    monkeypatch.setattr(Trainer, 'observe', observe)
    with pytest.raises(SystemExit, match=r'joint_angles.*step 2 of episode 3, seed 1') as stopped:
        run('--episodes', 4, '--config', config_file, '--out', part)
    assert str(part / train.CHECKPOINT) in str(stopped.value)
    monkeypatch.setattr(Trainer, 'observe', usual)
    assert checkpoint.load(part / train.CHECKPOINT).episode == 2
    run('--episodes', 4, '--out', part, '--resume')
    assert log(part) == log(whole)
