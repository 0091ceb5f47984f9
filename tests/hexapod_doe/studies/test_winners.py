# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.choosing.choice import decide
from hexapod_doe.choosing.outlook import final_outlook
from hexapod_doe.designs.design import fraction
from hexapod_doe.fitting.logistic import firth
from hexapod_doe.modelling.pipeline import run
from hexapod_doe.records.options import Options
from hexapod_doe.studies.stacked_fits import Terms, firth_stack
from hexapod_doe.studies.winners import Winners
from simulated import Truth, table_of

# Effects so small that campaigns of a few runs choose different sets.
CLOSE = {'1': 420, 'A': 6, 'B': 9, 'C': 15, 'D': -4, 'E': 5, 'AB': -5, 'CD': 6, 'CE': 4}
OFTEN = {'1': -1.5, 'B': -0.45, 'C': -0.55}


def cases_of(design: str) -> pd.DataFrame:
    found = fraction(design)
    return pd.DataFrame(found.levels, columns=list(found.factors))


def simulated(cases: pd.DataFrame, runs: int, count: int, failure: dict[str, float]) -> np.ndarray:
    truth, rng = Truth(success=CLOSE, failure=failure), np.random.default_rng(runs)
    return np.array(
        [[truth.simulate(cases, rng) for _ in range(runs)] for _ in range(count)]
    ).transpose(0, 2, 1)


KINDS = [(1, OFTEN), (2, OFTEN), (3, OFTEN), (7, OFTEN), (3, {'1': -50.0})]
"""Runs of a case, and the odds of failure."""


@pytest.mark.parametrize(
    ('design', 'kind'),
    [('quarter', 0), ('eighth', 1), ('eighth', 2), ('quarter+eighth', 3), ('eighth', 4)],
)
def test_winners_are_those_of_the_analysis(design: str, kind: int) -> None:
    check_winners(design, *KINDS[kind], count=1)


@pytest.mark.slow
@pytest.mark.timeout(1800)
@pytest.mark.parametrize('design', ['quarter', 'eighth', 'quarter+eighth'])
@pytest.mark.parametrize('kind', range(len(KINDS)))
def test_winners_of_every_kind_are_those_of_the_analysis(design: str, kind: int) -> None:
    check_winners(design, *KINDS[kind], count=6)


def check_winners(design: str, runs: int, failure: dict[str, float], count: int) -> None:
    cases = cases_of(design)
    values = simulated(cases, runs, count, failure)
    winners = Winners(cases)
    levels = cases.loc[cases.index.repeat(runs)].reset_index(drop=True)
    tables = [table_of(levels, each.ravel()) for each in values]
    named = [winners.labels[number] for number in winners.two_part(values)]
    assert named == [decide(table, Options()).ranking[0] for table in tables]
    procedure = Options(
        trim_worst=max(0, min(round(0.3 * runs), runs - 2)), transform='boxcox',
        eliminate=True, keep_main_effects=True,
    )  # fmt: skip
    named = [winners.labels[number] for number in winners.article(values)]
    rng = np.random.default_rng(1)
    assert named == [final_outlook(run(table, procedure), rng).ranking[0] for table in tables]


def test_stacked_odds_are_those_of_one_fit() -> None:
    cases = cases_of('quarter')
    terms = Terms(cases, ('1', 'A', 'B', 'C', 'D', 'E', 'F', 'G', 'BC'))
    failures = np.random.default_rng(1).integers(0, 4, (3, len(cases)))
    total = np.full_like(failures, 4)
    kept = np.ones((3, len(terms.names)), dtype=bool)
    coef, error = firth_stack(terms, failures, total, kept, np.zeros(kept.shape))
    for number, each in enumerate(failures):
        outcome = np.concatenate([[1.0] * k + [0.0] * (4 - k) for k in each])
        fit = firth(np.repeat(terms.columns, 4, axis=0), outcome)
        assert coef[number] == pytest.approx(fit.coef, abs=1e-7)
        assert error[number] == pytest.approx(np.sqrt(np.diag(fit.covariance)), rel=1e-6)
