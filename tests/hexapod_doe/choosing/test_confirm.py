# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import json
from pathlib import Path

import numpy as np
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.designs.design import fraction
from hexapod_doe.errors import AnalysisError
from hexapod_doe.fitting.model import model_matrix
from hexapod_doe.fitting.regression import ols
from hexapod_doe.records.options import Options
from hexapod_doe.records.results import Analysis
from hexapod_doe.tables.table import RunTable
from scipy import stats
from simulated import Truth, repeated_levels, table_of

from hexapod_doe import analyze


@pytest.fixture(scope='module')
def table() -> RunTable:
    """A campaign in which no run fails: 420 + … as the truth has it, sigma 40."""
    truth = Truth(failure={'1': -50.0})
    levels = repeated_levels(fraction('quarter'), 5)
    return table_of(levels, truth.simulate(levels, np.random.default_rng(1)))


@pytest.fixture(scope='module')
def analysis(table: RunTable) -> Analysis:
    return analyse([table], Options())


def test_the_interval_is_that_of_the_mean_of_new_runs(table: RunTable, analysis: Analysis) -> None:
    # s·√(q + 1/m) by simulation, from the terms up to order 2.
    terms = [term for term in analysis.steps[0].terms if len(term) < 3]
    fit = ols(table.levels, table.values, terms)
    check = analysis.confirmation.checks[0]
    point = table.levels.iloc[:1].copy()
    point.loc[:, :] = [[1 if letter in check.label else -1 for letter in 'ABCDEFG']]
    q = fit.unscaled_variance(model_matrix(point, terms))[0]
    half = stats.t.ppf(0.975, fit.df_error) * fit.s * np.sqrt(q + 1 / 5)
    assert check.interval[1] - check.interval[0] == pytest.approx(2 * half, rel=0.05)
    assert check.predicted == pytest.approx(np.mean(check.interval), abs=3)


def test_the_choice_and_the_two_next_wait_for_their_runs(analysis: Analysis) -> None:
    assert [check.label for check in analysis.confirmation.checks] == list(analysis.ranking[:3])
    assert all(check.passed is None for check in analysis.confirmation.checks)
    assert '5 new runs' in analysis.confirmation.rule


def test_runs_are_judged_by_their_mean(table: RunTable, analysis: Analysis) -> None:
    best, other, _ = analysis.confirmation.checks
    runs = {
        best.label: [float(np.mean(best.interval))] * 5,
        other.label: [other.interval[1] + 1] * 5,
    }
    judged = analyse([table], Options(), runs).confirmation.checks
    assert [(check.label, check.passed) for check in judged[:2]] == [
        (best.label, True),
        (other.label, False),
    ]


def test_more_runs_get_a_narrower_interval(table: RunTable) -> None:
    checks = analyse([table], Options(), {'ABC': [500.0] * 5, 'ABD': [400.0] * 50}).confirmation
    widths = {c.label: c.interval[1] - c.interval[0] for c in checks.checks}
    assert widths['ABD'] < widths['ABC']


def test_fewer_runs_than_the_rule_asks_for(table: RunTable) -> None:
    with pytest.raises(AnalysisError, match='ABC has 2 confirmation runs, the rule asks for 5'):
        analyse([table], Options(), {'ABC': [1.0, 2.0]})


def test_a_set_of_other_factors(table: RunTable) -> None:
    with pytest.raises(AnalysisError, match="'XY'"):
        analyse([table], Options(), {'XY': [1.0] * 5})


def test_the_command_line_judges(
    tmp_path: Path, table: RunTable, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(analyze, 'write_report', lambda analysis, out: out / 'index.html')
    table.rows.rename(columns={'response': 'y'}).to_csv(tmp_path / 'runs.csv', index=False)
    lines = ['A,B,C,D,E,F,G,y', *['1,1,1,1,1,-1,-1,600'] * 5]
    (tmp_path / 'new.csv').write_text('\n'.join(lines))
    status = analyze.main(
        [
            *('--table', str(tmp_path / 'runs.csv'), '--response', 'y'),
            *('--confirm', str(tmp_path / 'new.csv'), '--out', str(tmp_path / 'out')),
        ]
    )
    assert status == 0
    record = json.loads((tmp_path / 'out' / 'analysis.json').read_text())['confirmation']
    judged = [check for check in record['checks'] if check['observed']]
    assert [(check['label'], check['observed_mean']) for check in judged] == [('ABCDE', 600.0)]
