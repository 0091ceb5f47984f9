# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Published and full-precision numbers of textbook data sets.

The JSON files name the source of each number (`source`, `provenance`); `published` are printed
values, matched within half a unit of the last place, `fits` come from an independent program,
matched to 1e-9.
"""

import json
import re
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from hexapod_doe.designs.terms import CURVATURE
from hexapod_doe.fitting.curvature import curvature
from hexapod_doe.fitting.elimination import eliminate
from hexapod_doe.fitting.lenth import lenth
from hexapod_doe.fitting.model import estimable_terms
from hexapod_doe.fitting.regression import Fit, ols
from scipy import stats

DATA = Path(__file__).parents[1] / 'data' / 'doe_cases'
CASES = (
    'roughness_2_3_r2',
    'oxygen_2_2_cp',
    'plasma_2_4',
    'plasma_2_3_r2',
    'filtration_2_4',
    'injection_2_6_2',
    'leafspring_2_5_1_r3',
)
EXACT = {'rel': 1e-9, 'abs': 1e-9}


@cache
def load(case: str) -> SimpleNamespace:
    text = (DATA / f'{case}.json').read_text()
    expected = json.loads(text.replace('"CP"', f'"{CURVATURE}"'))
    rows = pd.read_csv(DATA / f'{case}.csv')
    factors = [name for name in rows.columns if len(name) == 1 and name != 'y']
    return SimpleNamespace(expected=expected, levels=rows[factors], y=rows['y'].to_numpy(float))


def fit_of(case: str, name: str) -> Fit:
    data = load(case)
    return ols(data.levels, data.y, data.expected['fits'][name]['terms'])


def model_f(fit: Fit) -> tuple[float, float]:
    """F of the whole model against the error, and its p."""
    df = len(fit.terms) - 1
    f = (fit.sst - fit.sse) / df / (fit.sse / fit.df_error)
    return f, float(stats.f.sf(f, df, fit.df_error))


ALL_FITS = [(case, name) for case in CASES for name in load(case).expected['fits']]


@pytest.mark.parametrize(('case', 'name'), ALL_FITS)
def test_full_precision_fit(case: str, name: str) -> None:
    expected, fit = load(case).expected['fits'][name], fit_of(case, name)
    assert fit.df_error == expected['df_error']
    assert fit.sse == pytest.approx(expected['SSE'], **EXACT)
    assert fit.sst == pytest.approx(expected['SST'], **EXACT)
    assert fit.r2 == pytest.approx(expected['R2'], **EXACT)
    by_term = {'coef': fit.coef, 'effects': 2 * fit.coef}
    if fit.df_error:
        by_term |= {'se': fit.se, 't': fit.t, 'p': fit.p, 'se_effect': 2 * fit.se}
        f, p_model = model_f(fit)
        numbers = {
            's': fit.s, 'MSE': fit.s**2, 'R2adj': fit.r2_adj, 'PRESS': fit.press,
            'R2pred': fit.r2_pred, 'F': f, 'p_model': p_model,
        }  # fmt: skip
        assert numbers == pytest.approx({key: expected[key] for key in numbers}, **EXACT)
    else:
        assert (fit.s, fit.se, fit.p, fit.press, fit.r2_adj, fit.r2_pred) == (None,) * 6
    for key, values in by_term.items():
        computed = dict(zip(fit.terms, values, strict=True))
        assert {term: computed[term] for term in expected[key]} == pytest.approx(
            expected[key], **EXACT
        )


def largest(case: str) -> Fit:
    names = load(case).expected['fits']
    return fit_of(
        case, next(name for name in ('full', 'saturated', 'with_curvature') if name in names)
    )


def smaller(case: str) -> Fit:
    names = load(case).expected['fits']
    return fit_of(
        case, next(n for n in ('reduced', 'full', 'saturated', 'with_curvature') if n in names)
    )


def by_term(fit: Fit, values: np.ndarray, term: str) -> float:
    names = {'intercept': '1', 'constant': '1', 'CP': CURVATURE}
    return float(values[fit.terms.index(names.get(term, term))])


def oxygen_numbers() -> dict[str, float]:
    """The analysis of variance of a 2^2 with centre points as the solution manual prints it."""
    data, fit = load('oxygen_2_2_cp'), fit_of('oxygen_2_2_cp', 'with_curvature')
    bend = curvature(data.levels, data.y)
    lack = fit.lack_of_fit
    squares = 4 * fit.coef**2  # four factorial runs
    a, b = squares[fit.terms.index('A')], squares[fit.terms.index('B')]
    f_model = (a + b) / 2 / fit.s**2
    f_bend = bend.ss / fit.s**2
    without = fit.sst - bend.ss
    half = stats.t.ppf(0.975, fit.df_error) * fit.se
    limits = {
        f'CI95 {side} {name}': by_term(fit, fit.coef + sign * half, name)
        for side, sign in (('low', -1), ('high', 1))
        for name in ('intercept', 'A', 'B', 'CP')
    }
    return limits | {
        'model SS (A,B)': a + b, 'A SS': a, 'B SS': b, 'curvature SS': bend.ss,
        'F model': f_model, 'F A': a / fit.s**2, 'F B': b / fit.s**2, 'F curvature': f_bend,
        'p model': stats.f.sf(f_model, 2, fit.df_error),
        'p curvature': stats.f.sf(f_bend, 1, fit.df_error),
        'residual SS': fit.sse, 'lack of fit SS': lack.ss_lack_of_fit,
        'pure error SS': lack.ss_pure_error, 'F lack of fit': lack.f, 'p lack of fit': lack.p,
        's': fit.s, 'mean': data.y.mean(), 'PRESS': fit.press, 'R2pred': fit.r2_pred,
        'R2 (curvature taken out of the total)': 1 - fit.sse / without,
        'R2adj (curvature taken out)': 1 - (fit.sse / fit.df_error) / (without / (fit.n - 2)),
    }  # fmt: skip


def summary(fit: Fit) -> dict[str, float]:
    numbers = {
        'SS total': fit.sst, 'SS error': fit.sse, 'SSE': fit.sse, 'SS model': fit.sst - fit.sse,
        'mean': fit.coef[0], 'constant': fit.coef[0], 'R2': fit.r2,
    }  # fmt: skip
    if fit.df_error:
        numbers |= {
            'MS error': fit.s**2, 's': fit.s, 'SE coef': fit.se[1], 'F model': model_f(fit)[0],
            'R2adj': fit.r2_adj, 'R2pred': fit.r2_pred, 'PRESS': fit.press,
        }  # fmt: skip
    return numbers


def compute(case: str, what: str) -> float:
    """Compute the number that a printed table calls `what`."""
    if case == 'oxygen_2_2_cp' and what in (numbers := oxygen_numbers()):
        return numbers[what]
    if what == 'Lenth PSE':
        return lenth(effects(largest(case))).pse
    fit = smaller(case) if what.startswith(('reduced', 'coef')) else largest(case)
    what = what.removeprefix('reduced ')
    if what in (numbers := summary(fit)):
        return numbers[what]
    kind, term = re.fullmatch(r'(effect|coef|SE coef|SE|t|p|p \(.*\)|SS) (\w+)', what).groups()
    values = {
        'effect': lambda: 2 * fit.coef,
        'coef': lambda: fit.coef,
        'SE coef': lambda: fit.se,
        'SE': lambda: fit.se,
        't': lambda: fit.t,
        'p': lambda: fit.p,
        'SS': lambda: fit.n * fit.coef**2,
    }[kind.split(' (')[0]]()
    return by_term(fit, values, term)


def effects(fit: Fit) -> dict[str, float]:
    return {t: float(2 * c) for t, c in zip(fit.terms, fit.coef, strict=True) if t != '1'}


PUBLISHED = [(case, i) for case in CASES for i in range(len(load(case).expected['published']))]


@pytest.mark.parametrize(('case', 'index'), PUBLISHED)
def test_printed_number(case: str, index: int) -> None:
    entry = load(case).expected['published'][index]
    decimals = len(entry['printed'].partition('.')[2])
    half_a_unit = 0.5 * 10.0**-decimals * (1 + 1e-9)
    known_misprints = {item['what'] for item in load(case).expected['discrepancies']}
    agrees = abs(compute(case, entry['what']) - entry['value']) <= half_a_unit
    # Table 14-17 prints two p-values computed from rounded F; Table 14-18 prints the exact ones.
    assert agrees == (entry['what'] not in known_misprints)


@pytest.mark.parametrize('case', ['roughness_2_3_r2', 'plasma_2_3_r2', 'leafspring_2_5_1_r3'])
def test_backward_elimination(case: str) -> None:
    data = load(case)
    expected = data.expected['backward_elimination']
    kept, trace = eliminate(
        data.levels, data.y, estimable_terms(data.levels), expected['alpha'], expected['hierarchy']
    )
    assert set(kept) == {'1', *expected['kept']}
    assert [item.term for item in trace] == [term for term, _ in expected['removed_in_order']]
    assert [item.p for item in trace] == pytest.approx(
        [p for _, p in expected['removed_in_order']], **EXACT
    )


@pytest.mark.parametrize('case', ['filtration_2_4', 'injection_2_6_2', 'plasma_2_4'])
def test_lenth(case: str) -> None:
    expected = load(case).expected['lenth']
    found = lenth(effects(largest(case)))
    numbers = [found.s0, found.pse, found.df, found.margin, found.simultaneous_margin]
    assert numbers == pytest.approx(
        [expected[key] for key in ('s0', 'PSE', 'd', 'ME', 'SME')], **EXACT
    )


@pytest.mark.parametrize(
    ('case', 'name'), [('oxygen_2_2_cp', 'with_curvature'), ('leafspring_2_5_1_r3', 'final')]
)
def test_lack_of_fit(case: str, name: str) -> None:
    expected = load(case).expected['lack_of_fit']
    found = fit_of(case, name).lack_of_fit
    numbers = {
        'SSPE': found.ss_pure_error, 'dfPE': found.df_pure_error, 'SSLOF': found.ss_lack_of_fit,
        'dfLOF': found.df_lack_of_fit, 'F': found.f, 'p': found.p,
    }  # fmt: skip
    assert numbers == pytest.approx(expected, **EXACT)


@pytest.mark.parametrize('case', ['injection_2_6_2', 'leafspring_2_5_1_r3'])
def test_saturated_terms(case: str) -> None:
    expected = load(case).expected['fits']['saturated']['terms']
    assert list(estimable_terms(load(case).levels)) == expected


def test_centre_points_add_a_curvature_term() -> None:
    assert CURVATURE in estimable_terms(load('oxygen_2_2_cp').levels)


def test_press_without_the_curvature_column() -> None:
    expected = load('oxygen_2_2_cp').expected['press_variants']
    fit = fit_of('oxygen_2_2_cp', 'without_curvature')
    assert fit.press == pytest.approx(expected['without_curvature_column'], **EXACT)
    assert fit.r2_pred == pytest.approx(expected['R2pred_without'], **EXACT)
