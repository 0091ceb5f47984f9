# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Numbers of docs/experiments.md are those of the designs, of the power and of the trainings."""

from __future__ import annotations

import re
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from hexapod_doe.designs.aliases import alias_text, clear_interactions, representatives
from hexapod_doe.designs.design import Design, fraction, from_generators
from hexapod_doe.designs.power import smallest_effect

DOCS = Path(__file__).resolve().parents[1] / 'docs'
PAGE = (DOCS / 'experiments.md').read_text(encoding='utf-8')
FRACTIONS = ('full', 'half', 'quarter', 'eighth')


def row(start: str) -> list[str]:
    """Return the cells of the last row of the page that begins so."""
    found = [line for line in PAGE.splitlines() if line.startswith(f'| {start}')]
    return [cell.strip() for cell in found[-1].strip('|').split('|')]


def trained(agent: str) -> list[int]:
    """Return the returns of an agent's seeds in docs/learning.md."""
    lines = (DOCS / 'learning.md').read_text(encoding='utf-8').splitlines()
    rows = [line.split('|') for line in lines if line.startswith(f'| {agent} |')]
    return [int(cells[3]) for cells in rows if re.fullmatch(r' \d{4} ', cells[3])][:5]


@pytest.mark.parametrize('agent', ['`ABCDE`', 'always-on alone'])
def test_returns_are_those_of_the_learner(agent: str) -> None:
    _, returns, mean, deviation = row(agent)
    found = np.array(trained(agent))
    assert returns == ', '.join(map(str, found))
    assert (int(mean), int(deviation)) == (round(found.mean()), round(found.std(ddof=1)))


def test_what_single_trainings_would_tell() -> None:
    five, alone = np.array(trained('`ABCDE`')), np.array(trained('always-on alone'))
    differences = [one - other for one, other in product(five, alone)]
    assert f'worth {min(differences)}, or {max(differences)}' in PAGE
    error = np.sqrt(five.var(ddof=1) / 5 + alone.var(ddof=1) / 5)
    told = f'differ by {five.mean() - alone.mean():.0f}, with a standard error of {error:.0f}'
    assert told in PAGE


def test_errors_of_the_two_ways() -> None:
    assert f'√(2/40) = {np.sqrt(2 / 40):.2f} σ' in PAGE
    assert f'√320 = {2 / np.sqrt(320):.2f} σ' in PAGE
    assert np.sqrt(2 / (1280 / 8)) == pytest.approx(2 / np.sqrt(320))


def worst(design: Design) -> str:
    """Return the name with the most aliases, of terms of up to two sensors."""
    terms = [*design.factors, *representatives(design.levels, design.factors, 2)]
    names = [alias_text(term, design.levels, design.factors) for term in terms]
    return max(names, key=lambda name: name.count('+'))


@pytest.mark.parametrize('name', [*FRACTIONS, 'plan --generators'])
def test_what_designs_confuse(name: str) -> None:
    cells = row(f'`{name}')
    if name in FRACTIONS:
        cells = next(
            [cell.strip() for cell in line.strip('|').split('|')]
            for line in PAGE.splitlines()
            if line.startswith(f'| `{name}` |')
        )
        design = fraction(name)
    else:
        design = from_generators(cells[0].strip('`').split()[-1], 7)
    assert int(cells[1]) == len(design.levels)
    assert int(cells[2]) == len(clear_interactions(design.levels, design.factors))
    quoted = re.findall(r'`(.*)`', cells[3])
    assert quoted == ([worst(design)] if '+' in worst(design) else [])


@pytest.mark.parametrize('name', FRACTIONS)
def test_effects_that_are_found(name: str) -> None:
    design = fraction(name)
    parameters = 1 + len(representatives(design.levels, design.factors, 2))
    found = [
        round(smallest_effect(len(design.levels) * runs, parameters), 2)
        for runs in (1, 2, 3, 5, 10)
    ]
    assert list(map(float, row(f'`{name}`')[1:])) == found
