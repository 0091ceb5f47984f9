# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The learning study: its table, its figure, and that a finished study is not repeated."""

import io
import time
from contextlib import redirect_stdout
from pkgutil import resolve_name

import pandas as pd
import pytest
from hexapod_doe.studies import learning

ARGUMENTS = ['--sets', 'C', '--seeds', '1', '--first-seed', '3', '--episodes', '2']
ARGUMENTS += ['--starts', '2', '--jobs', '1']
CONFIG = """
task: {time_limit_steps: 8}
ddpg: {update_every: 4}
actor: {hidden: [8, 8]}
critic: {hidden: [8, 8]}
training: {evaluation: 2, checkpoint_every: 1}
"""
as_ever = learning._python


@pytest.fixture(autouse=True)
def short_search(monkeypatch, tmp_path):
    """Stand in for the searches of walks without feedback, which take minutes.

    Programs run in this process, which has loaded the libraries; a test may have those that train
    run as the study does.
    """

    def python(module: str, *arguments: str) -> float:
        found = ('constant', 'open-loop')
        before = time.process_time()
        program = resolve_name(f'{module}:main')
        with redirect_stdout(io.StringIO()):
            program(['zero' if argument in found else argument for argument in arguments])
        return time.process_time() - before

    monkeypatch.setattr(learning, '_python', python)
    (tmp_path / 'short.yaml').write_text(CONFIG)


def test_study_leaves_its_table_and_is_not_repeated(tmp_path, capsys, monkeypatch):
    here = learning._python

    def python(module: str, *arguments: str) -> float:
        return (as_ever if module == 'hexapod_agent.train' else here)(module, *arguments)

    monkeypatch.setattr(learning, '_python', python)
    out = tmp_path / 'study'
    arguments = ['--out', str(out), '--config', str(tmp_path / 'short.yaml'), *ARGUMENTS]
    learning.main(arguments)
    table = pd.read_csv(out / 'table.csv')
    assert list(table['agent']) == ['zero action', 'constant action', 'open-loop gait', 'C']
    assert (list(table['seed'][3:]), list(table['steps'][3:])) == ([3], [16])
    judged = pd.read_csv(out / 'C_3' / 'evaluation.csv')['episode_return'].mean()
    assert table['evaluation_return'][3] == pytest.approx(judged)
    assert 0.1 < table['processor_seconds'][3] < 100.0
    assert table['gain'][1] == 0.0
    rewards = table['final_average_reward']
    assert list(table['gain']) == pytest.approx(list(rewards / rewards[1] - 1.0))
    assert (out / 'curves.png').stat().st_size > 1000

    def fail(*arguments: str) -> None:
        raise AssertionError(f'repeated: {arguments}')

    first = capsys.readouterr().out
    monkeypatch.setattr(learning, '_python', fail)
    learning.main(arguments)
    assert capsys.readouterr().out == first


def test_configurations_are_compared_side_by_side(tmp_path):
    (tmp_path / 'ppo.yaml').write_text(
        'task: {time_limit_steps: 8}\ntraining: {evaluation: 1}\n'
        'learner: {algorithm: ppo, ppo: {rollout_steps: 8, batch_size: 8, hidden: [8]}}\n'
    )
    configs = [str(tmp_path / 'short.yaml'), str(tmp_path / 'ppo.yaml')]
    learning.main(['--out', str(tmp_path / 'study'), '--config', *configs, *ARGUMENTS])
    table = pd.read_csv(tmp_path / 'study' / 'table.csv')
    assert list(table['agent'][3:]) == ['short: C', 'ppo: C']
    assert table['steps'][3] == table['steps'][4]
    assert (tmp_path / 'study' / 'ppo_C_3' / 'agent.pt').exists()
