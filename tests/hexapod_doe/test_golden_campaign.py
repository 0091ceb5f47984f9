# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The article's procedure on a synthetic quarter-fraction campaign, by the command line alone.

The golden numbers come from an independent program (`synth_2_7_2_r10.json`).
"""

import json
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from hexapod_doe.designs.terms import terms_up_to
from hexapod_doe.fitting.model import AliasedTermsError, estimable_terms
from hexapod_doe.fitting.regression import ols
from hexapod_doe.tables.csv_table import read_csv

from hexapod_doe import analyze

DATA = Path(__file__).parents[1] / 'data' / 'doe_cases'
EXACT = {'rel': 1e-9, 'abs': 1e-9}


@pytest.fixture(scope='module')
def golden() -> dict[str, Any]:
    return json.loads((DATA / 'synth_2_7_2_r10.json').read_text())


@pytest.fixture(scope='module')
def article(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    out = tmp_path_factory.mktemp('golden')
    source = ['--table', str(DATA / 'synth_2_7_2_r10.csv'), '--response', 'final_average_reward']
    assert analyze.main(['--article', *source, '--out', str(out)]) == 0
    assert (out / 'index.html').is_file()
    return json.loads((out / 'analysis.json').read_text())


def unscaled(step: dict[str, Any], article: dict[str, Any]) -> dict[str, Any]:
    """Return a step in the reference's units: (z^λ − 1)/λ, without the geometric mean g."""
    if step['scale'] != 'transformed':
        return step
    power, g = article['transform']['lambda'], article['transform']['scale']
    unit = g ** (power - 1)
    coef = {term: unit * value for term, value in step['coef'].items()}
    coef['1'] += (g**power - 1) / power - unit * g
    return step | {
        'coef': coef,
        'se': {term: unit * value for term, value in step['se'].items()},
        's': unit * step['s'],
        **{name: unit**2 * step[name] for name in ('sse', 'sst', 'press')},
    }


def test_each_step(article: dict[str, Any], golden: dict[str, Any]) -> None:
    expected = {
        'initial': 'step1_initial_saturated_all_reps',
        'trimmed': 'step2_trimmed_saturated',
        'transformed': 'step3_transformed_saturated',
        'final': 'step4_final',
    }
    names = {
        'R2': 'r2', 'R2adj': 'r2_adj', 'R2pred': 'r2_pred', 'PRESS': 'press', 's': 's',
        'SSE': 'sse', 'SST': 'sst', 'df_error': 'df_error', 'n': 'n',
    }  # fmt: skip
    assert [step['name'] for step in article['steps']] == list(expected)
    for step, key in zip(article['steps'], expected.values(), strict=True):
        for theirs, ours in names.items():
            assert unscaled(step, article)[ours] == pytest.approx(golden[key][theirs], **EXACT)
        assert len(step['terms']) == golden[key]['p']


def test_saturated_terms(article: dict[str, Any], golden: dict[str, Any]) -> None:
    assert article['steps'][0]['terms'] == ['1', *golden['saturated_terms']]


def test_final_coefficients(article: dict[str, Any], golden: dict[str, Any]) -> None:
    expected, final = golden['step4_final'], unscaled(article['steps'][-1], article)
    assert final['terms'] == expected['terms']
    for theirs, ours in (('coef', 'coef'), ('se', 'se'), ('pval', 'p')):
        assert final[ours] == pytest.approx(expected[theirs], rel=1e-8)
    assert final['aliases']['CE'] == 'CE + FG'
    lack, found = golden['step4_lack_of_fit'], final['lack_of_fit']
    assert found['f'] == pytest.approx(lack['F'], **EXACT)
    assert found['p'] == pytest.approx(lack['p'], **EXACT)


def test_elimination_trace(article: dict[str, Any], golden: dict[str, Any]) -> None:
    expected = golden['step4_final']['removed_in_order']
    assert [item['term'] for item in article['elimination']] == [term for term, _ in expected]
    assert [item['p'] for item in article['elimination']] == pytest.approx(
        [p for _, p in expected], **EXACT
    )


def test_transform(article: dict[str, Any], golden: dict[str, Any]) -> None:
    expected, found = golden['step3_boxcox'], article['transform']
    assert found['lambda'] == expected['lam_used']
    assert found['shift'] == pytest.approx(expected['shift'], **EXACT)
    # The maximum is flat: two optimisers agree to the root of the machine precision.
    assert found['lambda_hat'] == pytest.approx(expected['lam_hat'], rel=1e-8)
    assert found['lambda_ci'] == pytest.approx(expected['ci95'], rel=1e-8)


def test_shift_sensitivity(article: dict[str, Any]) -> None:
    checks = json.loads((DATA / 'formula_checks.json').read_text())
    expected = checks['boxcox_shift_sensitivity_synth_2_7_2']
    found = article['transform']['sensitivity']
    assert [row['shift'] for row in found] == pytest.approx([row['shift'] for row in expected])
    assert [row['lambda_hat'] for row in found] == pytest.approx(
        [row['lam'] for row in expected], rel=1e-6
    )


def test_predictions(article: dict[str, Any], golden: dict[str, Any]) -> None:
    expected = golden['predictions_128_90_original_units']
    found = article['predictions']
    assert [item['label'] for item in found] == expected['label']
    for values, key in (
        ([item['fit'] for item in found], 'fit'),
        ([item['ci'][0] for item in found], 'ci_lo'),
        ([item['ci'][1] for item in found], 'ci_hi'),
        ([item['pi'][0] for item in found], 'pi_lo'),
        ([item['pi'][1] for item in found], 'pi_hi'),
    ):
        blank = [value is None for value in expected[key]]
        assert [value is None for value in values] == blank
        known = [value for value in values if value is not None]
        assert known == pytest.approx([v for v in expected[key] if v is not None], rel=1e-8)


def test_the_top_three(article: dict[str, Any], golden: dict[str, Any]) -> None:
    best = sorted(article['predictions'], key=lambda item: item['rank'])[:3]
    for found, expected in zip(best, golden['top3'], strict=True):
        assert found['label'] == expected['label']
        assert found['fit'] == pytest.approx(expected['fit'], rel=1e-8)
        for kind in ('ci', 'pi'):
            assert found[kind] == pytest.approx(expected[kind], rel=1e-8)


def test_case_means(article: dict[str, Any], golden: dict[str, Any]) -> None:
    table = pd.DataFrame(article['table'])
    means = table.groupby('case')['response'].mean()
    assert means.tolist() == pytest.approx(golden['step1_case_means'], **EXACT)


def test_ranking_and_main_effects(article: dict[str, Any], golden: dict[str, Any]) -> None:
    assert article['ranking'] == golden['ranking']
    assert article['choice'] == golden['truth']['best_label']
    for item in article['main_effects']:
        expected = golden['main_effects_all_reps'][item['factor']]
        for key in ('mean_with', 'mean_without', 'effect', 'se_mean_with', 'se_mean_without'):
            assert item[key] == pytest.approx(expected[key], **EXACT)
        assert item['se_effect'] == pytest.approx(expected['se_effect_from_saturated'], **EXACT)


def test_the_switches_of_the_article_one_by_one(
    tmp_path: Path, article: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(analyze, 'write_report', lambda analysis, out: out / 'index.html')
    status = analyze.main(
        [
            *('--table', str(DATA / 'synth_2_7_2_r10.csv')),
            *('--response', 'final_average_reward', '--trim-worst', '3'),
            *('--transform', 'boxcox', '--eliminate', '--out', str(tmp_path)),
        ]
    )
    assert status == 0
    single = json.loads((tmp_path / 'analysis.json').read_text())
    assert single['steps'][-1] == article['steps'][-1]


def test_alias_attribution(article: dict[str, Any], golden: dict[str, Any]) -> None:
    expected, found = golden['alias_attribution'], article['attribution']
    assert found['ambiguous'] == expected['ambiguous_terms']
    assert found['attributions'] == expected['n_attributions']
    assert found['winners'] == expected['winners']


def test_a_confounded_term_is_neither_split_nor_silently_kept() -> None:
    # A fit by formula halves CE and gives the other half to FG without a word.
    trap = json.loads((DATA / 'formula_checks.json').read_text())[
        'statsmodels_aliased_columns_trap'
    ]
    table = read_csv(DATA / 'synth_2_7_2_r10.csv', 'final_average_reward')[0]
    with pytest.raises(AliasedTermsError, match='FG with CE'):
        ols(table.levels, table.values, ['1', *terms_up_to('ABCDEFG', 2)])
    fit = ols(table.levels, table.values, estimable_terms(table.levels, 2))
    index = fit.terms.index('CE')
    assert fit.coef[index] == pytest.approx(trap['CE_when_FG_left_out'], **EXACT)
    assert fit.p[index] == pytest.approx(trap['p_CE_clean'], **EXACT)
    assert (len(fit.terms), fit.df_error) == (trap['rank'], trap['df_resid_clean'])
