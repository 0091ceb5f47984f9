# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""From statistics to a purchase: prices, Pareto front, cheapest set not worse, breakage.

Decisions come from the draws of the selected model, numbers with intervals from the stated one.
"""

from collections.abc import Collection, Sequence

import numpy as np
from hexapod_sim.sums import ordered_sum

from hexapod_doe.choosing.devices import DeviceTable
from hexapod_doe.choosing.draws import interval_of
from hexapod_doe.choosing.outlook import Outlook, Stated
from hexapod_doe.fitting.model import EMPTY_SET
from hexapod_doe.records.findings import Breakage, Device, PricedSet, Purchase


def purchase(
    outlook: Outlook,
    table: DeviceTable,
    level: float,
    delta: float | None = None,
    free: Collection[str] = (),
) -> Purchase | None:
    """Price every combination and weigh it against its reward.

    Args:
        outlook: Values of the combinations.
        table: The devices.
        level: Confidence of the intervals.
        delta: What a set may be worse than the best, in reward units; None for the table's share.
        free: Factors that need no device.

    Returns:
        None where the model leaves no error.
    """
    if outlook.draws is None or outlook.stated is None:
        return None
    if delta is None:
        delta = table.delta_share * abs(float(np.nanmax(outlook.fits)))
    devices = [table.cheapest(set(letters_of(label)) - set(free)) for label in outlook.labels]
    cost = np.array([ordered_sum(device.cost for device in needed) for needed in devices])
    best = outlook.draws.max(axis=1, keepdims=True)
    not_worse = (outlook.draws >= best - delta).mean(axis=0)
    p_front = pareto(cost, outlook.draws).mean(axis=0)
    sets = _priced_sets(outlook, outlook.stated, devices, cost, p_front, not_worse, level)
    cheapest, rule = cheapest_not_worse(
        outlook.labels, cost, not_worse, outlook.fits, table.confidence
    )
    return Purchase(
        devices=table.devices,
        currency=table.currency,
        delta=float(delta),
        confidence=table.confidence,
        sets=sets,
        front=tuple(sets[i].label for i in np.argsort(cost, kind='stable') if sets[i].on_front),
        cheapest=cheapest,
        cheapest_rule=rule,
        breakage=tuple(
            loss
            for label in dict.fromkeys((outlook.ranking[0], cheapest))
            for loss in breakage(
                label,
                outlook.labels,
                devices[outlook.labels.index(label)],
                outlook.stated,
                level,
                free,
            )
        ),
    )


def _priced_sets(
    outlook: Outlook,
    stated: Stated,
    devices: Sequence[Sequence[Device]],
    cost: np.ndarray,
    p_front: np.ndarray,
    not_worse: np.ndarray,
    level: float,
) -> tuple[PricedSet, ...]:
    low, high = interval_of(stated.draws, level)
    front = pareto(cost, stated.fits[None, :])[0]
    return tuple(
        PricedSet(
            label=label,
            devices=tuple(device.name for device in devices[i]),
            cost=float(cost[i]),
            mass=ordered_sum(device.mass for device in devices[i]),
            power=ordered_sum(device.power for device in devices[i]),
            failure_probability=any_breaks(devices[i]),
            fit=float(stated.fits[i]),
            ci=(float(low[i]), float(high[i])),
            p_front=float(p_front[i]),
            on_front=bool(front[i]),
            p_not_worse=float(not_worse[i]),
        )
        for i, label in enumerate(outlook.labels)
    )


def letters_of(label: str) -> str:
    """Return the letters of a combination's label; none for the empty set."""
    return '' if label == EMPTY_SET else label


def any_breaks(devices: Sequence[Device]) -> float:
    """Return the probability that at least one device breaks."""
    return 1 - float(np.prod([1 - device.failure_probability for device in devices]))


def pareto(cost: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Tell which sets are on the front of high value against low cost in each row.

    A set is off the front if another one costs no more and is worth more, or costs less and is
    worth as much.

    Args:
        cost: Cost of each set (m,).
        values: Values, one draw a row (draws, m).

    Returns:
        Shape: (draws, m).
    """
    front = np.zeros(values.shape, dtype=bool)
    best = np.full(len(values), -np.inf)
    for level in np.unique(cost):
        group = np.flatnonzero(cost == level)
        top = values[:, group].max(axis=1)
        front[:, group] = (values[:, group] == top[:, None]) & (top > best)[:, None]
        best = np.maximum(best, top)
    return front


def cheapest_not_worse(
    labels: Sequence[str],
    cost: np.ndarray,
    not_worse: np.ndarray,
    fits: np.ndarray,
    confidence: float,
) -> tuple[str, str]:
    """Return the cheapest set that is not worse with the confidence asked for, and why.

    Where no set reaches the confidence, the one that comes nearest to it.
    """
    good = np.flatnonzero(not_worse >= confidence)
    if len(good):
        best = good[np.lexsort((-fits[good], cost[good]))[0]]
        return labels[best], (
            f'cheapest set within delta of the best with probability {not_worse[best]:.2f}'
        )
    best = int(np.argmax(not_worse))
    return labels[best], (
        f'no set is within delta of the best with probability {confidence:g}; this one comes '
        f'nearest ({not_worse[best]:.2f})'
    )


def breakage(
    label: str,
    labels: Sequence[str],
    devices: Sequence[Device],
    stated: Stated,
    level: float,
    free: Collection[str] = (),
) -> tuple[Breakage, ...]:
    """Return what each device of a set is worth: the reward lost without what it alone yields."""
    whole = labels.index(label)
    result = []
    for broken in devices:
        others = set(''.join(device.yields for device in devices if device is not broken))
        others |= set(free)
        left = ''.join(letter for letter in letters_of(label) if letter in others) or EMPTY_SET
        rest = labels.index(left)
        low, high = interval_of(stated.draws[:, whole] - stated.draws[:, rest], level)
        result.append(
            Breakage(
                label=label,
                device=broken.name,
                lost=''.join(letter for letter in letters_of(label) if letter not in others),
                remaining=left,
                fit=float(stated.fits[rest]),
                loss=float(stated.fits[whole] - stated.fits[rest]),
                loss_ci=(float(low), float(high)),
            )
        )
    return tuple(result)
