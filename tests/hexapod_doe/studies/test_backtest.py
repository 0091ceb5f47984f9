# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.designs.design import fraction
from hexapod_doe.errors import TableError
from hexapod_doe.studies.backtest import Whole, backtest, chart, rule_of_thumb
from hexapod_doe.tables.table import RunTable
from simulated import Truth, repeated_levels, table_of

RARE = {'1': -3.0, 'B': -0.5}


@pytest.fixture(scope='module')
def campaign() -> RunTable:
    levels = repeated_levels(fraction('quarter+eighth'), 4)
    return table_of(levels, Truth(failure=RARE).simulate(levels, np.random.default_rng(1)))


@pytest.fixture(scope='module')
def whole(campaign: RunTable) -> Whole:
    return Whole.of(campaign)


@pytest.fixture(scope='module')
def found(campaign: RunTable, whole: Whole) -> pd.DataFrame:
    return backtest(campaign, whole, draws=8)


def test_each_kind_of_smaller_campaign_is_judged(found: pd.DataFrame) -> None:
    kinds = found[['design', 'replicates', 'runs']].drop_duplicates().to_numpy().tolist()
    assert kinds == [
        ['quarter', 1, 32], ['quarter', 2, 64], ['quarter', 3, 96],
        ['eighth', 1, 16], ['eighth', 2, 32], ['eighth', 3, 48],
    ]  # fmt: skip
    assert (found['regret'] >= 0).all()
    assert (found['in_top_group'] >= found['same_winner']).all()


def test_more_runs_lose_less(found: pd.DataFrame) -> None:
    quarter = found[found['design'] == 'quarter'].groupby('replicates')['regret'].mean()
    assert quarter[3] < quarter[1]


def test_the_draws_are_those_of_their_seed(
    campaign: RunTable, whole: Whole, found: pd.DataFrame
) -> None:
    pd.testing.assert_frame_equal(backtest(campaign, whole, draws=8), found)
    assert not backtest(campaign, whole, draws=8, seed=2)['regret'].equals(found['regret'])


def test_the_rule_names_the_smallest_campaign_that_loses_little(
    whole: Whole, found: pd.DataFrame
) -> None:
    runs = int(found[found['regret'] <= whole.tolerance]['runs'].min())
    assert rule_of_thumb(whole, found).startswith(f'{runs} runs would have been enough of 160')
    worse = found.assign(regret=found['regret'] + 1000)
    assert 'No smaller campaign would have been enough' in rule_of_thumb(whole, worse)


def test_the_figure_is_written_with_its_numbers(found: pd.DataFrame, tmp_path: Path) -> None:
    chart(found, 'Enough.').save(tmp_path, tmp_path)
    assert (tmp_path / 'backtest.png').stat().st_size > 10_000
    assert len(pd.read_csv(tmp_path / 'backtest.csv')) == len(found)


def test_a_campaign_of_other_cases_is_refused(campaign: RunTable) -> None:
    whole = Whole(160, np.arange(128.0), 127, frozenset({127}), 5.0)
    single = replace(campaign, rows=campaign.rows.drop_duplicates('case').reset_index(drop=True))
    with pytest.raises(TableError, match='no design of quarter or eighth with two runs'):
        backtest(single, whole, draws=2)
