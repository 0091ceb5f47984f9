# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How sure the order of the combinations is, from draws of their values."""

from collections.abc import Sequence

import numpy as np
from scipy import stats

from hexapod_doe.choosing.draws import equal_within
from hexapod_doe.choosing.outlook import Outlook
from hexapod_doe.records.findings import RankUncertainty


def rank_uncertainty(outlook: Outlook, level: float) -> RankUncertainty | None:
    """Summarise the ranks of the combinations.

    The probabilities and groups come from draws of the selected model, the rank intervals from
    the one before selection, each of which is true to the frequencies in its own (see
    `outlook`).

    Args:
        outlook: Values of the combinations.
        level: Confidence of the rank intervals and of the groups.

    Returns:
        None where the model leaves no error.
    """
    if outlook.draws is None or outlook.stated is None:
        return None
    low, high = np.quantile(
        ranks_of(outlook.stated.draws),
        [(1 - level) / 2, (1 + level) / 2],
        axis=0,
        method='inverted_cdf',
    )
    return RankUncertainty(
        draws=len(outlook.draws),
        p_best=_map(outlook.labels, share_of_top(outlook.draws, 1)),
        p_top3=_map(outlook.labels, share_of_top(outlook.draws, 3)),
        rank_interval={
            label: (int(a), int(b)) for label, a, b in zip(outlook.labels, low, high, strict=True)
        },
        groups=groups(outlook.draws, outlook.fits, outlook.labels, level),
    )


def ranks_of(draws: np.ndarray) -> np.ndarray:
    """Return the ranks within each draw, 1 for the highest value (draws, m)."""
    ranks = np.empty(draws.shape, dtype=np.int32)
    order = np.argsort(-draws, axis=1, kind='stable')
    np.put_along_axis(ranks, order, np.arange(1, draws.shape[1] + 1), axis=1)
    return ranks


def share_of_top(draws: np.ndarray, top: int) -> np.ndarray:
    """Return the probability that each combination is among the best `top` (m,).

    Combinations of equal value, such as those that differ in a factor which the model has not
    kept, share the places that they take: they sum to `top`.
    """
    best = draws.max(axis=1, keepdims=True)
    values = np.round((best - draws) / equal_within(draws)[:, None])
    first = stats.rankdata(values, method='min', axis=1)
    last = stats.rankdata(values, method='max', axis=1)
    places = np.clip(top + 1 - first, 0, last + 1 - first)
    return (places / (last + 1 - first)).mean(axis=0)


def groups(
    draws: np.ndarray, fits: np.ndarray, labels: Sequence[str], level: float
) -> tuple[tuple[str, ...], ...]:
    """Split the combinations, best first, into runs that can't be told from their first one.

    A combination joins the group while the first one is better in fewer than `level` of the
    draws; ties don't count as better.
    """
    order = np.argsort(-np.nan_to_num(fits, nan=-np.inf), kind='stable')
    result: list[list[str]] = []
    head = -1
    for index in order:
        if head >= 0 and (draws[:, head] > draws[:, index]).mean() < level:
            result[-1].append(labels[index])
        else:
            head = int(index)
            result.append([labels[index]])
    return tuple(map(tuple, result))


def _map(labels: Sequence[str], values: np.ndarray) -> dict[str, float]:
    return {label: float(value) for label, value in zip(labels, values, strict=True)}
