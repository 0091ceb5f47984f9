# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Says what design the rows of a table show, and what a reader must know about it."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from hexapod_doe.designs.aliases import defining_relation, defining_words, resolution
from hexapod_doe.fitting.alias_matrix import short_alias, with_partial_aliases
from hexapod_doe.fitting.model import centre_points, corners, labels
from hexapod_doe.fitting.transform import BOUNDS
from hexapod_doe.records.results import Analysis, DesignSummary
from hexapod_doe.tables.table import BLOCK, RunTable

_MISSING_SHARE = 0.25
"""With more of a fraction missing than this the design was never meant to be that fraction."""

_SCORING = 'task.'
"""What the key of a factor begins with that changes reward, start or limits."""
_NAMED = 5
"""Sets that a sentence names before it counts the rest."""


def summarise(table: RunTable, aliases: Mapping[str, str]) -> DesignSummary:
    """Describe the design that the rows of a table show."""
    missing, expected = missing_cases(table.levels)
    relation, length = describe_words(table.levels)
    centre = centre_points(table.levels)
    runs = table.rows[~centre].groupby('case').size()
    regular = len(missing) <= _MISSING_SHARE * expected
    return DesignSummary(
        name=table.design or _size(len(table.factors), expected, len(runs), regular),
        factors=table.factors,
        factor_names=table.factor_names,
        named=table.named,
        defining_relation=relation,
        resolution=length,
        cases=len(runs),
        expected_cases=expected if regular else len(runs),
        missing_cases=missing if regular else (),
        runs=len(table.rows),
        replicates=(int(runs.min()), int(runs.max())),
        centre_points=int(centre.sum()),
        block_column=table.block_column,
        blocks=table.rows[BLOCK].nunique() if table.block_column else 0,
        aliases=aliases,
    )


def _size(factors: int, expected: int, cases: int, regular: bool) -> str:
    generated = factors - expected.bit_length() + 1
    if not regular:
        return f'{cases} cases of 2^{factors}'
    return f'2^({factors}-{generated})' if generated else f'2^{factors}'


def design_caveats(design: DesignSummary) -> list[str]:
    """Return what a reader must know about missing cases and unequal replicates."""
    caveats = []
    if design.missing_cases:
        caveats.append(
            f'{len(design.missing_cases)} of {design.expected_cases} cases are missing '
            f'({", ".join(design.missing_cases[:8])}): the columns are no longer orthogonal, '
            'standard errors differ and some terms may be left out.'
        )
    low, high = design.replicates
    if low != high:
        caveats.append(f'Cases have between {low} and {high} runs: the fit weighs each run alike.')
    return caveats


def scoring_caveats(design: DesignSummary, response: str) -> list[str]:
    """Return what a reader must know where a factor changes how runs are scored."""
    scoring = [factor.name for factor in design.named if factor.key.startswith(_SCORING)]
    if not scoring or response.endswith('falls'):
        return []
    return [
        f'{", ".join(scoring)}: part of the task, which the reward is computed by. Effects on '
        f'{response.replace("_", " ")} hold how runs are scored, not only how they walk; '
        '--response evaluation_falls does not depend on the weights.'
    ]


def model_caveats(analysis: Analysis) -> list[str]:
    """Return what a reader must know about the fit, the transform and the names of effects."""
    caveats = []
    lack, alpha = analysis.final.lack_of_fit, analysis.options['alpha']
    if lack is not None and lack.p < alpha:
        caveats.append(
            f'The final model does not fit all cases (lack of fit p = {lack.p:.2g}): they differ '
            'from it by more than their runs differ among themselves, so that its classical '
            'intervals are too short.'
        )
    caveats += _block_caveats(analysis)
    bend = analysis.curvature
    if bend is not None and bend.p is not None and bend.p < alpha:
        side = 'below' if bend.difference > 0 else 'above'
        caveats.append(
            f'The centre points lie {abs(bend.difference):.3g} {side} what the other runs '
            f'foretell for them (curvature p = {bend.p:.2g}): between the levels of the numeric '
            'factors the response bends, and the best setting may lie there.'
        )
    transform = analysis.transform
    if transform is not None and transform.lambda_ci is not None:
        low, high = transform.lambda_ci
        if low <= 1 <= high:
            caveats.append('λ = 1 is within its interval: the response needs no transform.')
        if low <= BOUNDS[0] or high >= BOUNDS[1]:
            caveats.append(
                f'The interval of λ, {low:.2g} to {high:.2g}, ends where the search ended: these '
                'runs hardly tell λ.'
            )
    caveats += _partial_caveat(analysis)
    attribution = analysis.attribution
    if attribution is not None and attribution.ambiguous:
        names = ', '.join(' or '.join(group) for group in attribution.ambiguous.values())
        safe, total = len(attribution.safe), len(analysis.predictions)
        winners = ', '.join(list(attribution.winners)[:_NAMED])
        if len(attribution.winners) > _NAMED:
            winners += f' and {len(attribution.winners) - _NAMED} more'
        caveats.append(
            f'The runs do not tell which effect is real: {names}. {total - safe} of {total} '
            f'predictions depend on the name; best under some name: {winners}.'
        )
    return caveats


def _partial_caveat(analysis: Analysis) -> list[str]:
    partial = {} if analysis.attribution is None else analysis.attribution.partial
    if not partial:
        return []
    term, others = next(iter(partial.items()))
    named = short_alias(with_partial_aliases(term, others), _NAMED)
    average = ''
    if analysis.averaging is not None:
        average = (
            ' The average over models, which weighs those interactions as well, chooses '
            f'{analysis.averaging.choice}.'
        )
    return [
        f'{len(partial)} of the effects hold parts of interactions that the model leaves out '
        f'({named}): they are right only if those interactions are nil, and no prediction is '
        f'alias-safe.{average}'
    ]


def _block_caveats(analysis: Analysis) -> list[str]:
    test, design = analysis.final.blocks, analysis.design
    if test is None:
        return []
    text = (
        f'Runs are compared within {design.blocks} blocks by {design.block_column}: effects and '
        'differences between sets are free of them, intervals of means and of new runs allow for '
        'other blocks.'
    )
    if test.p is not None:
        differ = 'differ' if test.p < analysis.options['alpha'] else "don't differ"
        text += f' Blocks {differ} by more than runs of one block do (p = {test.p:.2g}).'
    return [text]


def missing_cases(levels: pd.DataFrame) -> tuple[tuple[str, ...], int]:
    """Return the labels that the smallest regular fraction around the rows has and they lack.

    Returns:
        The missing labels in Yates order and the number of cases of that fraction.
    """
    factors = [str(name) for name in levels.columns]
    factorial = levels[~centre_points(levels)].drop_duplicates()
    words = defining_words(factorial.to_numpy(float), ''.join(factors))
    grid = corners(factors)
    inside = np.ones(len(grid), dtype=bool)
    for word, sign in words.items():
        inside &= grid[list(word)].prod(axis=1).to_numpy() == sign
    run = set(labels(factorial))
    expected = labels(grid[inside])
    return tuple(label for label in expected if label not in run), len(expected)


def describe_words(levels: pd.DataFrame) -> tuple[str, int | None]:
    """Return the defining relation of the rows and their resolution (None: a full factorial)."""
    factorial = levels[~centre_points(levels)].drop_duplicates()
    words = defining_words(factorial.to_numpy(float), ''.join(map(str, levels.columns)))
    return defining_relation(words), resolution(words)
