# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Analyses that the report is tested with: a tour, and a campaign with failed runs."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.designs.design import fraction
from hexapod_doe.designs.factor import default_factors
from hexapod_doe.designs.plan_table import make_plan
from hexapod_doe.records.options import Options
from hexapod_doe.records.results import Analysis
from hexapod_doe.reporting.report import write_report
from hexapod_doe.tables.table import RunTable, build_rows

LETTERS = 'ABCDEFG'  # of the design, however many sensors the table has
NAMES = tuple('ABCDEFG')
EFFECTS = np.array([10, 25, 60, 20, 30, -8, -12])
"""Half the effect of each sensor on the reward after a long training; C matters most."""


def simulated(
    design: str, replicates: int, episodes: int, *, failing: float = 0.0, seed: int = 1
) -> RunTable:
    """Return the runs of a design whose truth is known; failing runs end near zero."""
    rng = np.random.default_rng(seed)
    rows = make_plan(fraction(design), replicates, seed).rows
    level = 420 + rows[list(NAMES)].to_numpy() @ EFFECTS + 30 * rows['C'] * rows['E']
    level = level.to_numpy() + rng.normal(0, 30, len(rows))
    level = np.where(rng.random(len(rows)) < failing, rng.normal(60, 15, len(rows)), level)
    progress = 1 - np.exp(-np.arange(episodes) / 100)
    returns = 150 + np.outer(level - 150, progress) + rng.normal(0, 20, (len(rows), episodes))
    average = returns.cumsum(axis=1) / np.arange(1, episodes + 1)
    if episodes > 100:
        average[:, 50:] = returns[:, 50:]
    raw = rows.assign(response=average[:, -1])
    built, caveats = build_rows(raw, list(NAMES))
    curves = pd.DataFrame(
        {
            **{name: np.repeat(built[name], episodes) for name in ('run_id', 'label', 'case')},
            'replicate': np.repeat(built['replicate'], episodes),
            'episode': np.tile(np.arange(episodes), len(rows)),
            'return': returns.ravel(),
            'average': average.ravel(),
        }
    )
    return RunTable(
        'Test campaign', 'bags/test', 'final_average_reward', NAMES, built, caveats,
        design, default_factors(NAMES), curves,
    )  # fmt: skip


@pytest.fixture(scope='session')
def tour() -> Analysis:
    """Sixteen cases, one run each, four episodes: the demo."""
    return analyse([simulated('eighth', 1, 4)], Options())


@pytest.fixture(scope='session')
def campaign() -> Analysis:
    """The eighth with six runs per case and failures, compared with another such campaign."""
    tables = [simulated('eighth', 6, 600, failing=0.1, seed=seed) for seed in (2, 3)]
    return analyse(tables, Options())


@pytest.fixture(scope='session')
def article() -> Analysis:
    """The same runs by the article's procedure."""
    return analyse([simulated('eighth', 6, 600, failing=0.1, seed=2)], Options(article=True))


@pytest.fixture(scope='session')
def tour_page(tour: Analysis, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of the tour."""
    return write_report(tour, tmp_path_factory.mktemp('tour'))


@pytest.fixture(scope='session')
def campaign_page(campaign: Analysis, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of the campaign."""
    return write_report(campaign, tmp_path_factory.mktemp('campaign'))
