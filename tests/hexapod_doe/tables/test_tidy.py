# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Exported tables hold what the bags hold, and explain themselves."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import statsmodels.formula.api as smf
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.bags.run_record import read_run
from hexapod_doe.designs.plan_file import read_plan
from hexapod_doe.records.options import Options
from hexapod_doe.tables.bag_table import read_bags

from hexapod_doe import export

CAMPAIGN = Path(__file__).parents[3] / 'bags' / 'sample_campaign'


@pytest.fixture(scope='module')
def tables(tmp_path_factory: pytest.TempPathFactory) -> dict[str, pd.DataFrame]:
    """The sample campaign, written and read back."""
    out = tmp_path_factory.mktemp('export') / 'runs.csv'
    assert export.main([str(CAMPAIGN), '--out', str(out)]) == 0
    return {
        path.stem: pd.read_csv(path, keep_default_na=False) for path in out.parent.glob('*.csv')
    }


def test_a_row_for_each_run_and_each_episode(tables: dict[str, pd.DataFrame]) -> None:
    runs, episodes = tables['runs'], tables['runs_episodes']
    plan = read_plan(CAMPAIGN / 'plan.csv').rows.set_index('run_id')
    columns = ['case', 'replicate', 'seed', *'ABC']
    pd.testing.assert_frame_equal(
        runs.set_index('run_id')[columns].sort_index(),
        plan[columns].sort_index(),
        check_dtype=False,
    )
    assert list(runs['run_order']) == list(range(1, 9))
    for run_id in ('case01_rep01', 'case03_rep02'):
        bag = read_run(CAMPAIGN / 'runs' / run_id)
        own = episodes[episodes['run_id'] == run_id]
        returns = own.loc[own['phase'] == 'training', 'episode_return']
        assert np.array_equal(returns, bag.episodes['episode_return'])
        judged = own.loc[own['phase'] == 'evaluation', 'episode_return'].mean()
        row = runs.set_index('run_id').loc[run_id]
        assert row['evaluation_return'] == pytest.approx(judged)
        assert row['final_average_reward'] == bag.episodes['average_return'].iloc[-1]


def test_every_column_has_a_meaning(tables: dict[str, pd.DataFrame]) -> None:
    columns = tables['runs_columns']
    for table in ('runs', 'episodes'):
        own = columns[columns['table'] == table]
        name = 'runs' if table == 'runs' else 'runs_episodes'
        assert list(own['column']) == list(tables[name])
    assert columns['meaning'].str.len().gt(0).all()
    assert 'body orientation off → on' in set(columns['meaning'])


def test_another_programs_fit_of_the_table_has_the_same_effects(
    tables: dict[str, pd.DataFrame],
) -> None:
    fit = smf.ols('evaluation_return ~ A + B + C', tables['runs']).fit()
    ours = analyse(read_bags([CAMPAIGN]), Options(terms='A,B,C', eliminate=False)).model('final')
    for term in 'ABC':
        assert fit.params[term] == pytest.approx(ours.params[term], rel=1e-9)
        assert fit.bse[term] == pytest.approx(ours.bse[term], rel=1e-9)


def test_campaigns_are_named_by_their_folder(tmp_path: Path) -> None:
    for name in ('first', 'second/confirm'):
        shutil.copytree(CAMPAIGN, tmp_path / name)
    assert export.main([str(tmp_path), '--out', str(tmp_path / 'all.csv')]) == 0
    runs = pd.read_csv(tmp_path / 'all.csv')
    assert runs.groupby('campaign').size().to_dict() == {'first': 8, 'second/confirm': 8}


def test_nothing_to_export_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert export.main([str(tmp_path), '--out', str(tmp_path / 'runs.csv')]) == 2
    error = capsys.readouterr().err
    assert error == f'export: {tmp_path}: no bag of a complete run\n'
    assert not list(tmp_path.glob('*.csv'))
