# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a reader must know about failures and about runs that scatter unequally."""

from collections.abc import Mapping

import numpy as np

from hexapod_doe.designs.terms import is_interaction
from hexapod_doe.fitting.dispersion import Dispersion
from hexapod_doe.records.findings import Estimate, TwoPart

_APART = 0.25
"""Where two statements of a mean differ for more than this share of the sets, one is wrong."""

_ENOUGH = 3
"""Runs of a case from which on the chances of a choice came true in the study of coverage."""


def failure_caveats(record: TwoPart, alpha: float, noun: str = 'factor') -> list[str]:
    """Return what a reader must know about failed runs and about their model."""
    text = (
        f'{record.failures} of {record.runs} runs failed (response below {record.threshold:g}): '
        'the classical intervals of the final model treat them as noise; the two-part model '
        'treats them as what they are.'
    )
    if record.cases_without_success:
        names = ', '.join(record.cases_without_success)
        text += (
            f' No run of {names} succeeded: its reward given success is extrapolated from the '
            'other cases.'
        )
    caveats = [text]
    if not any(map(is_interaction, record.failure_terms)):
        caveats.append(
            'There are too few failures, or successes, for interactions in the model of failures: '
            f'it holds main effects only, and its intervals hold only if no {noun} changes what '
            'another one does to the chance of failure.'
        )
    misfit = record.failure_lack_of_fit
    if misfit is not None and misfit < alpha:
        caveats.append(
            f'The model of failures does not fit the shares of all cases (p = {misfit:.2g}): '
            'chances of failure, expected rewards and the chance to be the best set that it '
            'states are not to be relied on; the estimand mean does not use it.'
        )
    return caveats


def few_runs_caveat(runs: int) -> list[str]:
    """Return what a reader must know of a choice by fewer than three runs of a case."""
    if runs >= _ENOUGH:
        return []
    return [
        'With fewer than three runs of a case, some of which fail, the chances to be the best set '
        'and not to be worse than it are too sure: in simulated campaigns with two runs a chance '
        'of 0.95 came true in 0.60.'
    ]


def disagreement_caveat(
    expected: Mapping[str, Estimate], mean: Mapping[str, Estimate]
) -> list[str]:
    """Return the caveat where two statements of the mean of a set contradict each other.

    Args:
        expected: By the two-part model.
        mean: By the estimand `mean`, which knows no failures.
    """
    apart = [
        label
        for label, one in expected.items()
        if one.ci[0] is not None
        and one.ci[1] is not None
        and not (one.ci[0] <= mean[label].fit <= one.ci[1])
    ]
    if len(apart) <= _APART * len(expected):
        return []
    return [
        f'The mean reward by the two-part model and by the runs as they are differ for '
        f'{len(apart)} of {len(expected)} sets by more than the interval of the former: the '
        'two-part model, and with it the choice, misses something that the runs show.'
    ]


def unseen_caveat(parting: float | None, response: np.ndarray) -> list[str]:
    """Return what was assumed where the runs fall into two groups and none is called failed."""
    if parting is None:
        return []
    low = int((response < parting).sum())
    return [
        f'The runs fall into two groups, {low} below {parting:.4g} and {len(response) - low} '
        'above, which are taken for one: more than half of the runs are below, or most of these '
        'are of cases without a run above. If the lower ones failed, say so '
        f'(--failure-threshold {parting:.4g}); as it is, the models take them for noise.'
    ]


def dispersion_caveat(found: Dispersion | None, what: str) -> list[str]:
    """Return what a reader must know where runs scatter more at one level of a factor."""
    if found is None or not found.active:
        return []
    ratios = ', '.join(
        f'{found.ratio[name]:.2g} times with {name} (p = {found.p[name]:.2g})'
        for name in found.active
    )
    return [
        f'The {what} scatter unequally: their deviation is {ratios}. Intervals before elimination '
        'allow for it; those of the final model assume one deviation for all sets.'
    ]
