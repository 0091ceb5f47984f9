# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Judges confirmation runs by the rule that was fixed before them.

A set is confirmed if the mean of its new runs lies in the prediction interval of the mean of as
many runs. The confidence interval of the mean won't do: one run varies by σ around it.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from hexapod_doe.choosing.draws import interval_of
from hexapod_doe.choosing.outlook import Outlook, Stated
from hexapod_doe.designs.plan_types import Confirmation as Rule
from hexapod_doe.errors import AnalysisError
from hexapod_doe.records.findings import Confirmation, ConfirmationCheck

_TOP = 3


def confirm(
    outlook: Outlook, rule: Rule, observed: Mapping[str, Sequence[float]]
) -> Confirmation | None:
    """State the intervals of the best sets, and judge the runs that there are.

    Args:
        outlook: The model that the choice was made from.
        rule: Runs of a set, and confidence.
        observed: Responses of the confirmation runs by label; empty before they are run.

    Returns:
        None where the model leaves no error to state an interval with.

    Raises:
        AnalysisError: A set has fewer runs than the rule asks for, or is unknown.
    """
    stated = outlook.stated
    if stated is None:
        return None
    unknown = [label for label in observed if label not in outlook.labels]
    if unknown:
        raise AnalysisError(
            f'confirmation runs of {unknown[0]!r}: not a combination of the factors'
        )
    for label, values in observed.items():
        if len(values) < rule.runs:
            raise AnalysisError(
                f'{label} has {len(values)} confirmation runs, the rule asks for {rule.runs}'
            )
    wanted = dict.fromkeys((*outlook.ranking[:_TOP], *observed))
    sizes = {label: len(observed.get(label, ())) or rule.runs for label in wanted}
    bounds = {
        size: interval_of(stated.future_mean(size), rule.level) for size in set(sizes.values())
    }
    return Confirmation(
        level=rule.level,
        runs=rule.runs,
        rule=f'{rule.rule} The interval comes from the {outlook.model} before elimination.',
        checks=tuple(
            _check(
                label, outlook.labels.index(label), stated, bounds, observed.get(label, ()), size
            )
            for label, size in sizes.items()
        ),
    )


def _check(
    label: str,
    index: int,
    stated: Stated,
    bounds: Mapping[int, tuple[np.ndarray, np.ndarray]],
    values: Sequence[float],
    runs: int,
) -> ConfirmationCheck:
    low, high = (float(bound[index]) for bound in bounds[runs])
    mean = float(np.mean(values)) if len(values) else None
    return ConfirmationCheck(
        label=label,
        predicted=float(stated.fits[index]),
        interval=(low, high),
        runs=runs,
        observed=tuple(map(float, values)),
        observed_mean=mean,
        passed=None if mean is None else low <= mean <= high,
    )
