# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Malformed and unusual tables: a right analysis with a stated caveat, or one clear error."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.designs.design import fraction
from hexapod_doe.errors import TableError
from hexapod_doe.fitting.regression import ols
from hexapod_doe.tables.csv_table import read_csv, read_responses
from hexapod_doe.tables.table import RunTable

from hexapod_doe import analyze

Run = Callable[..., dict[str, Any]]


def campaign(replicates: int = 4, name: str = 'eighth', seed: int = 5) -> pd.DataFrame:
    """A small campaign whose response is 300 + 80 C + 30 A and noise."""
    design = fraction(name)
    levels = np.repeat(design.levels, replicates, axis=0)
    rows = pd.DataFrame(levels, columns=list(design.factors))
    rows.insert(0, 'case', np.repeat(np.arange(1, design.cases + 1), replicates))
    rows.insert(1, 'replicate', np.tile(np.arange(1, replicates + 1), design.cases))
    noise = np.random.default_rng(seed).normal(0, 20, len(rows))
    return rows.assign(y=300 + 80 * rows['C'] + 30 * rows['A'] + noise)


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out the report, which its own tests draw, and shorten what is sampled."""
    monkeypatch.setattr('hexapod_doe.choosing.averaging.SWEEPS', 20)
    monkeypatch.setattr(analyze, 'write_report', lambda analysis, out: out / 'index.html')


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Run the command line on rows and return analysis.json."""

    def run(rows: pd.DataFrame, *options: str) -> dict[str, Any]:
        rows.to_csv(tmp_path / 'runs.csv', index=False)
        arguments = ['--table', str(tmp_path / 'runs.csv'), '--response', 'y', *options]
        assert analyze.main([*arguments, '--out', str(tmp_path / 'out')]) == 0
        return json.loads((tmp_path / 'out' / 'analysis.json').read_text())

    return run


@pytest.fixture
def fails(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Callable[..., str]:
    """Run the command line on rows that it must refuse, and return its one line."""

    def fails(rows: pd.DataFrame, *options: str) -> str:
        rows.to_csv(tmp_path / 'runs.csv', index=False)
        arguments = ['--table', str(tmp_path / 'runs.csv'), '--response', 'y', *options]
        assert analyze.main([*arguments, '--out', str(tmp_path / 'out')]) == 2
        text = complaint(capsys.readouterr().err)
        assert text.count('\n') == 1
        assert not (tmp_path / 'out').exists()
        return text

    return fails


def complaint(text: str) -> str:
    """Return what a command said, less the lines on what is under way, as on a busy machine."""
    return ''.join(line for line in text.splitlines(keepends=True) if not line.endswith(' ...\n'))


def caveat(analysis: dict[str, Any], words: str) -> str:
    found = [text for text in analysis['caveats'] if words in text]
    assert len(found) == 1
    return found[0]


def read(rows: pd.DataFrame, path: Path) -> RunTable:
    rows.to_csv(path / 'runs.csv', index=False)
    return read_csv(path / 'runs.csv', 'y')[0]


@pytest.mark.parametrize('level', ['2', '0', 'on', ''])
def test_levels_that_are_not_plus_or_minus_one(fails: Callable[..., str], level: str) -> None:
    rows = campaign().astype({'B': object})
    rows.loc[6, 'B'] = level
    text = fails(rows)
    assert "row 7, column 'B'" in text
    assert 'expected -1 or 1' in text


def test_a_factor_that_never_changes(fails: Callable[..., str]) -> None:
    assert "factor 'G' is 1 in every row" in fails(campaign().assign(G=1))


def test_a_constant_response(fails: Callable[..., str]) -> None:
    assert 'the response is 5 in every row' in fails(campaign().assign(y=5))


def test_no_response_at_all(fails: Callable[..., str]) -> None:
    assert 'no row has a response' in fails(campaign().assign(y=np.nan))


def test_a_response_that_is_no_number(fails: Callable[..., str]) -> None:
    rows = campaign().astype({'y': object})
    rows.loc[3, 'y'] = 'crashed'
    assert "row 4: response 'crashed', expected a number" in fails(rows)


def test_an_empty_table(fails: Callable[..., str]) -> None:
    assert 'no rows' in fails(campaign().iloc[:0])


def test_an_unknown_response(tmp_path: Path) -> None:
    campaign().to_csv(tmp_path / 'runs.csv', index=False)
    with pytest.raises(TableError, match=r"no column 'reward'.*expected one of case, replicate"):
        read_csv(tmp_path / 'runs.csv', 'reward')


def test_an_unknown_factor(tmp_path: Path) -> None:
    campaign().to_csv(tmp_path / 'runs.csv', index=False)
    with pytest.raises(TableError, match="no factor column 'Z'"):
        read_csv(tmp_path / 'runs.csv', 'y', ['A', 'Z'])


def test_a_table_without_factors(fails: Callable[..., str]) -> None:
    assert 'no column named by one capital letter' in fails(
        pd.DataFrame({'x': [1, 2], 'y': [1, 2]})
    )


def test_other_columns_are_ignored(run: Run) -> None:
    plain = run(campaign())
    noted = run(campaign().assign(note='x', operator=3))
    assert noted['steps'] == plain['steps']


def test_missing_runs_are_left_out(run: Run) -> None:
    rows = campaign()
    rows.loc[[2, 9], 'y'] = np.nan
    analysis = run(rows)
    assert 'row 3, 10' in caveat(analysis, '2 rows have no response')
    assert analysis['steps'][0]['n'] == 62
    assert analysis['design']['replicates'] == [3, 4]


def test_missing_cases_are_named(run: Run) -> None:
    rows = campaign()
    analysis = run(rows[~rows['case'].isin([3, 8])])
    text = caveat(analysis, '2 of 16 cases are missing')
    assert 'BEF' in text  # case 3 of the eighth is B with E = ABC and F = BCD
    assert analysis['steps'][0]['df_error'] == 56 - len(analysis['steps'][0]['terms'])
    assert len(analysis['steps'][0]['terms']) == 14
    assert {'A', 'C'} <= set(analysis['steps'][-1]['terms'])


def test_missing_cases_give_the_least_squares_answer(tmp_path: Path) -> None:
    rows = campaign()
    table = read(rows[rows['case'] != 5], tmp_path)

    fit = ols(table.levels, table.values, ('1', 'A', 'C'))
    matrix = np.column_stack([np.ones(60), table.rows['A'], table.rows['C']])
    assert fit.coef == pytest.approx(np.linalg.lstsq(matrix, table.values)[0])


def test_one_replicate(run: Run) -> None:
    analysis = run(campaign(replicates=1))
    initial, reduced = analysis['steps']
    assert (initial['df_error'], initial['press'], initial['se']['A']) == (0, None, None)
    assert reduced['terms'] == ['1', *'ABCDEFG']
    assert reduced['df_error'] == 8
    assert 'C' in analysis['lenth']['active']
    assert all(None not in item['ci'] for item in analysis['predictions'])
    assert analysis['main_effects'][0]['se_effect'] is None  # they are of the first model
    caveat(analysis, 'takes up every run and leaves no error')
    assert analysis['estimands'] == []


def test_one_replicate_kept_saturated(run: Run) -> None:
    analysis = run(campaign(replicates=1), '--no-eliminate')
    assert len(analysis['steps']) == 1
    assert analysis['predictions'][0]['ci'] == [None, None]
    assert (analysis['rank_uncertainty'], analysis['confirmation']) == (None, None)


def test_trimming_one_replicate(fails: Callable[..., str]) -> None:
    assert 'dropping the worst 3 of each case leaves none' in fails(campaign(1), '--article')


def test_a_response_without_noise(run: Run) -> None:
    rows = campaign()
    analysis = run(rows.assign(y=300 + 80 * rows['C']))
    assert analysis['steps'][-1]['terms'] == ['1', 'C']
    assert analysis['steps'][-1]['r2'] == pytest.approx(1)


def test_a_response_of_noise_only(run: Run) -> None:
    rows = campaign()
    analysis = run(
        rows.assign(y=np.random.default_rng(3).normal(size=len(rows))), '--alpha', '1e-6'
    )
    assert analysis['steps'][-1]['terms'] == ['1']
    caveat(analysis, 'No term is significant')


def test_negative_rewards_with_box_cox(run: Run) -> None:
    rows = campaign()
    analysis = run(rows.assign(y=rows['y'] - 400), '--transform', 'boxcox')
    transform = analysis['transform']
    low, high = (rows['y'] - 400).min(), (rows['y'] - 400).max()
    assert transform['shift'] == pytest.approx(-low + 0.05 * (high - low))
    assert len(transform['sensitivity']) == 7
    caveat(analysis, 'was shifted by')
    assert analysis['predictions'][-1]['fit'] == pytest.approx(10, abs=30)  # 300 + 110 - 400


def test_a_lambda_that_the_search_cuts_off(run: Run) -> None:
    # The range is a hundredth of the mean, so that every power is nearly linear: no λ is better.
    rows = campaign()
    analysis = run(rows.assign(y=30_000 + rows['y']), '--transform', 'boxcox')
    caveat(analysis, 'ends where the search ended: these runs hardly tell λ')


def test_repeated_rows_count_once(run: Run) -> None:
    rows = campaign()
    analysis = run(pd.concat([rows, rows.iloc[[4]]]))
    caveat(analysis, '1 rows repeat another one (case 2, replicate 1)')
    assert analysis['steps'] == run(rows)['steps']


def test_repeated_runs_with_different_results(fails: Callable[..., str]) -> None:
    rows = campaign()
    text = fails(pd.concat([rows, rows.iloc[[4]].assign(y=0.0)]))
    assert 'case 2, replicate 1 occurs twice with different results' in text


def test_equal_rows_without_a_name_are_replicates(run: Run) -> None:
    rows = campaign().drop(columns=['case', 'replicate'])
    analysis = run(pd.concat([rows, rows.iloc[[4]]]))
    caveat(analysis, 'count as replicates')
    assert analysis['steps'][0]['n'] == 65


def test_case_numbers_that_disagree_with_the_levels(run: Run) -> None:
    analysis = run(campaign().assign(case=1).drop(columns='replicate'))
    caveat(analysis, "'case' disagrees with the levels")
    assert analysis['design']['cases'] == 16


def test_all_runs_of_a_case_failed(run: Run) -> None:
    rows = campaign(replicates=8, name='quarter')
    failed = (rows['case'] == 4) | (rows['replicate'] == 1)
    rows.loc[failed, 'y'] = np.random.default_rng(6).normal(-100, 15, failed.sum())
    analysis = run(rows)
    two_part = analysis['two_part']
    assert two_part['failures'] == failed.sum() == 39
    assert two_part['cases_without_success'] == ['ABFG']
    assert 'No run of ABFG succeeded' in caveat(analysis, 'runs failed')
    assert analysis['table']['failed'] == failed.tolist()


def test_terms_that_the_runs_cannot_tell_apart(fails: Callable[..., str]) -> None:
    text = fails(campaign(), '--terms', 'A,AB,CE')
    assert 'CE with AB' in text


@pytest.mark.parametrize(
    ('options', 'words'),
    [
        (['--terms', 'A,X'], "unknown factor 'X'"),
        (['--transform', 'cube'], "transform 'cube'"),
        (['--estimand', 'median'], "estimand 'median'"),
        (['--estimand', 'best_of:9'], 'needs 10 of each case'),
        (['--estimand', 'iqm', '--trim-worst', '1'], 'leave out --trim-worst'),
        (['--devices', 'nowhere.yaml'], 'nowhere.yaml'),
    ],
)
def test_options_that_make_no_sense(
    fails: Callable[..., str], options: list[str], words: str
) -> None:
    assert words in fails(campaign(), *options)


def test_an_empty_file(tmp_path: Path) -> None:
    (tmp_path / 'runs.csv').write_text('')
    with pytest.raises(TableError, match='empty file'):
        read_csv(tmp_path / 'runs.csv', 'y')


def test_a_design_column_splits_the_table(run: Run) -> None:
    both = pd.concat(
        [
            campaign(2, 'quarter').assign(design='quarter'),
            campaign(2, 'eighth').assign(design='eighth'),
        ]
    )
    analysis = run(both)
    assert analysis['design']['name'] == 'quarter'
    assert [other['design']['name'] for other in analysis['compared']] == ['eighth']
    assert len(analysis['compared'][0]['predictions']) == 128


def test_a_union_of_designs_is_no_regular_fraction(run: Run) -> None:
    both = pd.concat([campaign(2, 'quarter'), campaign(2, 'eighth')]).drop(
        columns=['case', 'replicate']
    )
    analysis = run(both)
    assert analysis['design']['name'] == '40 cases of 2^7'
    assert analysis['design']['missing_cases'] == []


def test_responses_by_label(tmp_path: Path) -> None:
    rows = pd.DataFrame({'A': [1, 1, -1], 'B': [-1, -1, -1], 'y': [3.0, 4.0, 5.0]})
    rows.to_csv(tmp_path / 'new.csv', index=False)
    assert read_responses(tmp_path / 'new.csv', 'y') == {'(none)': [5.0], 'A': [3.0, 4.0]}


def test_ten_factors_are_no_trouble(run: Run) -> None:
    levels = fraction('half', 9).levels
    rows = pd.DataFrame(levels, columns=list('ABCDEFGHJ'))
    noise = np.random.default_rng(1).normal(size=len(rows))
    analysis = run(rows.assign(y=rows['A'] + noise), '--max-order', '2')
    assert len(analysis['predictions']) == 512
