# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The learning study: its table, its figure, and that a finished study is not repeated."""

import pandas as pd
import pytest
from hexapod_doe.studies import learning

ARGUMENTS = ['--sets', 'C', '--seeds', '1', '--first-seed', '3', '--episodes', '2']
ARGUMENTS += ['--starts', '2']
CONFIG = """
task: {time_limit_steps: 8}
ddpg: {update_every: 4}
actor: {hidden: [8, 8]}
critic: {hidden: [8, 8]}
training: {evaluation: 2, checkpoint_every: 1}
"""


@pytest.fixture(autouse=True)
def short_search(monkeypatch, tmp_path):
    """Stand in for the search of the constant action, which takes minutes."""
    run = learning._python

    def python(module: str, *arguments: str) -> float:
        words = ('zero' if argument == 'constant' else argument for argument in arguments)
        return run(module, *words)

    monkeypatch.setattr(learning, '_python', python)
    (tmp_path / 'short.yaml').write_text(CONFIG)


def test_study_leaves_its_table_and_is_not_repeated(tmp_path, capsys, monkeypatch):
    out = tmp_path / 'study'
    arguments = ['--out', str(out), '--config', str(tmp_path / 'short.yaml'), *ARGUMENTS]
    learning.main(arguments)
    table = pd.read_csv(out / 'table.csv')
    assert list(table['agent']) == ['zero action', 'constant action', 'C']
    assert list(table['seed'][2:]) == [3]
    judged = pd.read_csv(out / 'C_3' / 'evaluation.csv')['episode_return'].mean()
    assert table['evaluation_return'][2] == pytest.approx(judged)
    assert 0.1 < table['processor_seconds'][2] < 100.0
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
