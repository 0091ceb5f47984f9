# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How sure the order of the combinations is, from draws of their values."""

from collections.abc import Sequence

import numpy as np

from hexapod_doe.findings import RankUncertainty


def rank_uncertainty(
    draws: np.ndarray, fits: np.ndarray, labels: Sequence[str], level: float
) -> RankUncertainty:
    """Rank each draw and summarise.

    Args:
        draws: Draws of the values (draws, m).
        fits: Point values (m,), by which the groups are ordered.
        labels: Names (m,).
        level: Confidence of the rank intervals and of the groups.
    """
    ranks = np.empty(draws.shape, dtype=np.int32)
    np.put_along_axis(
        ranks, np.argsort(-draws, axis=1, kind='stable'), np.arange(1, draws.shape[1] + 1), axis=1
    )
    low, high = np.quantile(
        ranks, [(1 - level) / 2, (1 + level) / 2], axis=0, method='inverted_cdf'
    )
    return RankUncertainty(
        draws=len(draws),
        p_best=_map(labels, (ranks == 1).mean(axis=0)),
        p_top3=_map(labels, (ranks <= 3).mean(axis=0)),
        rank_interval={
            label: (int(a), int(b)) for label, a, b in zip(labels, low, high, strict=True)
        },
        groups=groups(draws, fits, labels, level),
    )


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
