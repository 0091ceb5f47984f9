# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The figure that turns predictions into a purchase: reward against cost."""

from collections.abc import Sequence

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexapod_doe.records.findings import PricedSet, Purchase
from hexapod_doe.records.results import Analysis
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.figures.parts import canvas, unit_label
from hexapod_doe.reporting.figures.style import BLUE, INK, MUTED, ORANGE, SURFACE
from hexapod_doe.reporting.formats import number, percent


def cost_front(analysis: Analysis) -> Chart | None:
    """Draw every set's predicted reward against the cost of its devices, and the front."""
    purchase = analysis.purchase
    if purchase is None:
        return None

    def draw() -> Figure:
        figure, axes = canvas(4.0)
        _draw_front(axes, purchase)
        axes.set_xlabel(f'cost of the devices / {purchase.currency}')
        axes.set_ylabel(f'predicted {unit_label(analysis)}')
        return figure

    return Chart(
        'cost_front',
        _title(purchase),
        'Each point is a set. The line joins the sets that no cheaper one beats; bars are '
        f'{100 * analysis.level:g} % intervals of their means. Orange: the cheapest set that is '
        f'not worse than the best by more than {number(purchase.delta)}.',
        pd.DataFrame([_record(priced) for priced in purchase.sets]),
        draw,
    )


def _draw_front(axes: Axes, purchase: Purchase) -> None:
    by_label = {priced.label: priced for priced in purchase.sets}
    front = [by_label[label] for label in purchase.front]
    axes.plot(
        [s.cost for s in purchase.sets], [s.fit for s in purchase.sets], 'o', color=MUTED,
        markersize=3, alpha=0.45, markeredgewidth=0,
    )  # fmt: skip
    axes.step([s.cost for s in front], [s.fit for s in front], where='post', color=BLUE)
    for priced in front:
        _draw_member(axes, priced, BLUE)
    chosen = by_label[purchase.cheapest]
    _draw_member(axes, chosen, ORANGE)
    _annotate(axes, [*front, *([] if chosen in front else [chosen])], chosen)


def _draw_member(axes: Axes, priced: PricedSet, colour: str) -> None:
    low, high = priced.ci
    if low is not None and high is not None:
        axes.vlines(priced.cost, low, high, color=colour, linewidth=1.1, alpha=0.6)
    axes.plot(priced.cost, priced.fit, 'o', color=colour, markersize=6, markeredgecolor=SURFACE)


def _annotate(axes: Axes, named: Sequence[PricedSet], chosen: PricedSet) -> None:
    """Name sets at their upper left, which a front leaves free, a free one at its right.

    The chosen one first, then from the best down; what would cover a name goes without.
    """
    width, height = (high - low for low, high in (axes.get_xlim(), axes.get_ylim()))
    placed: list[PricedSet] = []
    for priced in sorted(named, key=lambda priced: (priced is not chosen, -priced.fit)):
        if any(
            abs(priced.cost - other.cost) < 0.15 * width
            and abs(priced.fit - other.fit) < 0.05 * height
            for other in placed
        ):
            continue
        left = priced.cost > 0
        axes.annotate(
            priced.label, (priced.cost, priced.fit), (-5, 5) if left else (6, -12),
            textcoords='offset points', ha='right' if left else 'left',
            color=ORANGE if priced is chosen else INK,
        )  # fmt: skip
        placed.append(priced)


def _title(purchase: Purchase) -> str:
    by_label = {priced.label: priced for priced in purchase.sets}
    chosen = by_label[purchase.cheapest]
    best = max(purchase.sets, key=lambda priced: priced.fit)
    price = f'{number(chosen.cost)} {purchase.currency}'
    if chosen.label == best.label:
        return f'The best set, {best.label}, is also the cheapest that is not worse: {price}'
    saved = percent(1 - chosen.cost / best.cost) if best.cost else percent(0)
    return f'{chosen.label} costs {price}, {saved} less than the best set {best.label}'


def _record(priced: PricedSet) -> dict[str, object]:
    return {
        'label': priced.label,
        'cost': priced.cost,
        'mass': priced.mass,
        'power': priced.power,
        'failure_probability': priced.failure_probability,
        'fit': priced.fit,
        'ci_low': priced.ci[0],
        'ci_high': priced.ci[1],
        'on_front': priced.on_front,
        'p_front': priced.p_front,
        'p_not_worse': priced.p_not_worse,
    }
