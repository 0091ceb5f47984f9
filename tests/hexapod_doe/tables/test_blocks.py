# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Seeds and batches as blocks, from the table to what the analysis says."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.designs.design import fraction
from hexapod_doe.designs.plan_table import make_plan
from hexapod_doe.errors import TableError
from hexapod_doe.records.options import Options
from hexapod_doe.records.results import Analysis
from hexapod_doe.tables.csv_table import read_csv

LUCK = (-80.0, -40.0, 0.0, 40.0, 80.0)
"""What each seed adds to every run of it."""
NOISE = 20.0


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr('hexapod_doe.choosing.averaging.SWEEPS', 20)


@pytest.fixture
def campaign() -> pd.DataFrame:
    """An eighth fraction with the same five seeds in every case."""
    rows = make_plan(fraction('eighth'), 5, common_seeds=True).rows
    rng = np.random.default_rng(2)
    luck = dict(zip(rows['seed'].unique(), LUCK, strict=True))
    noise = rng.normal(0, NOISE, len(rows)) + rows['seed'].map(luck)
    return rows.assign(y=300 + 80 * rows['C'] + 8 * rows['A'] + noise)


def analysis_of(rows: pd.DataFrame, folder: Path, blocks: str, **options: object) -> Analysis:
    rows.to_csv(folder / 'runs.csv', index=False)
    return analyse(read_csv(folder / 'runs.csv', 'y', blocks=blocks), Options(**options))


def test_seeds_as_blocks_sharpen_every_effect(campaign: pd.DataFrame, tmp_path: Path) -> None:
    plain, blocked = (analysis_of(campaign, tmp_path, name) for name in ('', 'seed'))
    first, sharp = plain.steps[0], blocked.steps[0]
    # Every case has every seed: no coefficient moves, and the seeds leave the error.
    assert sharp.coef == pytest.approx(first.coef)
    assert sharp.df_error == first.df_error - 4
    assert sharp.blocks is not None
    assert first.sse == pytest.approx(sharp.sse + sharp.blocks.ss)
    assert sharp.s == pytest.approx(NOISE, rel=0.25)
    assert first.s > 3 * sharp.s
    assert 'A' in blocked.final.terms
    assert 'A' not in plain.final.terms
    assert (blocked.design.block_column, blocked.design.blocks) == ('seed', 5)


def test_a_caveat_says_what_the_blocks_do(campaign: pd.DataFrame, tmp_path: Path) -> None:
    found = analysis_of(campaign, tmp_path, 'seed')
    (text,) = (text for text in found.caveats if '5 blocks by seed' in text)
    assert 'Blocks differ by more than runs of one block do' in text
    test = found.final.blocks
    assert test is not None
    assert (test.df, test.p < 1e-6) == (4, True)


def test_what_goes_beyond_the_fit_knows_the_blocks(campaign: pd.DataFrame, tmp_path: Path) -> None:
    plain, blocked = (analysis_of(campaign, tmp_path, name) for name in ('', 'seed'))
    assert plain.averaging is not None
    assert blocked.averaging is not None
    assert blocked.averaging.p_active['A'] > plain.averaging.p_active['A']
    assert plain.purchase is not None
    assert blocked.purchase is not None
    widths = [
        np.mean([item.loss_ci[1] - item.loss_ci[0] for item in found.purchase.breakage])
        for found in (plain, blocked)
    ]
    assert widths[1] < 0.6 * widths[0]


def test_failures_are_modelled_beside_blocks(campaign: pd.DataFrame, tmp_path: Path) -> None:
    rows = campaign.copy()
    rows.loc[rows.index[::7], 'y'] = -500.0 + np.arange(len(rows.index[::7]))
    found = analysis_of(rows, tmp_path, 'seed').two_part
    assert found is not None
    assert found.failures == 12
    assert found.success_coef['C'] == pytest.approx(80, abs=3 * NOISE / np.sqrt(68))


def test_a_block_generator_is_no_effect(tmp_path: Path) -> None:
    plan = make_plan(fraction('quarter'), 2, blocks=['ACE'])
    later = plan.rows['block'] == 2
    noise = np.random.default_rng(3).normal(0, NOISE, len(plan.rows))
    rows = plan.rows.assign(y=300 + 80 * plan.rows['C'] + 200 * later + noise)
    plain, blocked = (analysis_of(rows, tmp_path, name) for name in ('', 'block'))
    assert 'ACE' in plain.final.terms  # the block, taken for an interaction
    assert 'ACE' not in blocked.steps[0].terms
    assert any('ACE cannot be told from the differences' in text for text in blocked.caveats)


@pytest.mark.parametrize('article', [False, True])
def test_blocks_go_through_every_step(
    campaign: pd.DataFrame, tmp_path: Path, article: bool
) -> None:
    found = analysis_of(
        campaign, tmp_path, 'seed', article=article, transform='boxcox', estimand='mean'
    )
    assert found.final.blocks is not None
    assert found.transform is not None


def test_seeds_of_their_own_are_no_blocks(tmp_path: Path) -> None:
    rows = make_plan(fraction('eighth'), 2).rows
    with pytest.raises(TableError, match=r'no block holds runs of two cases.*--common-seeds'):
        analysis_of(rows.assign(y=rows['RunOrder']), tmp_path, 'seed')


def test_one_block_is_no_block(campaign: pd.DataFrame, tmp_path: Path) -> None:
    with pytest.raises(TableError, match='every run is in block 1, expected two'):
        analysis_of(campaign.assign(day=1), tmp_path, 'day')


def test_every_run_needs_a_block(campaign: pd.DataFrame, tmp_path: Path) -> None:
    rows = campaign.assign(day=[1.0, np.nan] + [2.0] * 78)
    with pytest.raises(TableError, match='row 2: no block'):
        analysis_of(rows, tmp_path, 'day')


def test_an_unknown_column(campaign: pd.DataFrame, tmp_path: Path) -> None:
    with pytest.raises(TableError, match="no column 'machine' for blocks, expected one of StdOr"):
        analysis_of(campaign, tmp_path, 'machine')
