# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The command line `train`: its files, resuming, and what it refuses."""

import csv
import re

import numpy as np
import pytest
import yaml
from hexapod_agent.training import Trainer

from hexapod_agent import checkpoint, train


@pytest.fixture
def config_file(small_config, tmp_path):
    path = tmp_path / 'small.yaml'
    mapping = small_config.to_mapping()
    mapping['training']['checkpoint_every'] = 2
    path.write_text(yaml.safe_dump(mapping))
    return path


def run(*arguments) -> None:
    train.main([str(argument) for argument in arguments])


def log(directory) -> list[dict[str, str]]:
    with (directory / train.LOG).open() as file:
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
    agent = checkpoint.load(out / train.AGENT)
    assert (agent.spec.letters, agent.seed, agent.episode) == ('BC', 2, 3)
    printed = capsys.readouterr().out.replace('\n', '')
    assert f'final average reward {agent.average_return:.1f}' in printed
    assert train.AGENT in printed


def test_resumed_log_is_the_uninterrupted_one(config_file, tmp_path):
    whole, part = tmp_path / 'whole', tmp_path / 'part'
    run('--episodes', 5, '--config', config_file, '--out', whole)
    run('--episodes', 3, '--config', config_file, '--out', part)
    run('--episodes', 5, '--out', part, '--resume')
    assert log(part) == log(whole)
    assert len(log(whole)) == 5


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        (('--observations', 'ABX'), "unknown letter 'X'"),
        (('--config', 'no.yaml'), "'no.yaml' not found"),
        (('--resume',), 'checkpoint.*not found'),
    ],
)
def test_wrong_arguments_are_one_clear_error(tmp_path, capsys, arguments, message):
    with pytest.raises(SystemExit):
        run('--out', tmp_path / 'run', *arguments)
    assert re.search(message, capsys.readouterr().err)


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
    assert checkpoint.load(part / train.CHECKPOINT, to_resume=True).episode == 2
    run('--episodes', 4, '--out', part, '--resume')
    assert log(part) == log(whole)
