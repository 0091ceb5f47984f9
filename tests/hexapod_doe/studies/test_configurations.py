# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The study of configurations: its rows, its table, and that a cut training goes on."""

import re

import pandas as pd
import pytest
import yaml
from hexapod_agent.train import train_episode
from hexapod_doe.studies import configurations
from hexapod_doe.studies.configuration_study import NONE, Run, Study
from hexapod_doe.studies.configurations import Training

SMALL = """
task: {time_limit_steps: 8}
ddpg: {batch_size: 4, update_every: 4}
actor: {hidden: [8, 8]}
critic: {hidden: [8, 8]}
training: {evaluation: 0, checkpoint_every: 1}
"""
STUDY = {
    'config': 'small.yaml',
    'base': {'ddpg.n_step': 3},
    'factors': {
        'ratio': {'low': {'ddpg.update_ratio': 0.25}, 'high': {'ddpg.update_ratio': 0.5}},
        'norm': {
            'low': {'actor.layer_norm': False, 'critic.layer_norm': False},
            'high': {'actor.layer_norm': True, 'critic.layer_norm': True},
        },
    },
    'rows': ['+-', '-+'],
    'sets': ['C', NONE],
    'seeds': [5],
    'episodes': 3,
    'judged_after': [2],
    'starts': 1,
}


@pytest.fixture
def write(tmp_path):
    def write(**changes):
        (tmp_path / 'small.yaml').write_text(SMALL)
        path = tmp_path / 'study.yaml'
        path.write_text(yaml.safe_dump(STUDY | changes, sort_keys=False))
        return path

    return write


def test_a_row_is_the_levels_of_its_factors(write):
    config = Study.load(write()).configuration('-+')
    assert (config.learner.ddpg.n_step, config.learner.ddpg.update_ratio) == (3, 0.25)
    assert (config.learner.actor.layer_norm, config.learner.critic.layer_norm) == (True, True)
    assert (config.task.time_limit_steps, config.training.episodes) == (8, 3)


def test_study_leaves_its_table_and_is_not_repeated(write, tmp_path, monkeypatch, capsys):
    arguments = [str(write(rows=['+-'])), '--out', str(tmp_path / 'out')]
    configurations.main(arguments)
    assert 'failed: less than' in capsys.readouterr().out
    table = pd.read_csv(tmp_path / 'out' / 'results.csv')
    assert sorted(zip(table['sensors'], table['episode'], strict=True)) == [
        ('C', 2), ('C', 3), (NONE, 2), (NONE, 3),
    ]  # fmt: skip
    assert set(table['ddpg.update_ratio']) == {0.5}
    assert set(table['actor.layer_norm']) == {False}
    assert (table['cpu_s'] > 0.0).all()

    def fail(*arguments, **options) -> None:
        raise AssertionError(f'repeated: {arguments}')

    monkeypatch.setattr(configurations.subprocess, 'run', fail)
    configurations.main(arguments)


def test_a_training_that_was_cut_gives_the_same_line(write, tmp_path, monkeypatch):
    study, run = Study.load(write()), Run('-+', 'C', 5)
    tables = []
    for name in ('whole', 'cut'):
        out = tmp_path / name
        out.mkdir()
        if name == 'cut':

            def cut(env, trainer):
                if trainer.episode == 2:
                    raise KeyboardInterrupt
                return train_episode(env, trainer)

            monkeypatch.setattr(configurations, 'train_episode', cut)
            with pytest.raises(KeyboardInterrupt):
                Training(study, run, out).train()
            monkeypatch.undo()
        Training(study, run, out).train()
        tables.append(pd.read_csv(out / 'results.csv').drop(columns='cpu_s'))
    pd.testing.assert_frame_equal(*tables)


def test_a_table_of_another_study_is_refused(write, capsys, tmp_path):
    (tmp_path / 'results.csv').write_text('row,sensors,seed\n+-,C,5\n')
    with pytest.raises(SystemExit):
        configurations.main([str(write()), '--out', str(tmp_path)])
    assert 'expected a table of this study, with row, ' in capsys.readouterr().err


@pytest.mark.parametrize(
    ('changes', 'message'),
    [
        ({'rows': ['+']}, "row '[+]', expected 2 signs"),
        ({'rows': ['+0']}, "row '[+]0', expected 2 signs"),
        ({'seeds': [1]}, 'seed 1 is that of the starts'),
        ({'sets': ['X']}, "unknown letter 'X'"),
        ({'base': {'ddpg.gamma': 1}}, "unknown key 'learner.ddpg.gamma'"),
        ({'base': {'ddpg.update_every': 3}}, 'update_ratio is 0.5, expected a multiple of 1/3'),
        ({'episodes': 0}, 'episodes'),
        ({'config': 'no.yaml'}, 'no.yaml.* not found'),
    ],
)
def test_studies_that_cannot_be_trained_are_refused(write, capsys, tmp_path, changes, message):
    path = write(**changes)
    with pytest.raises(SystemExit) as caught:
        configurations.main([str(path), '--out', str(tmp_path / 'out')])
    assert caught.value.code == 2
    assert re.search(message, capsys.readouterr().err)
