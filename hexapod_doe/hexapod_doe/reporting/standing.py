# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Where each set stands by the model that the choice is made from, for the report.

Without failed runs that is the final model. With them it is the two-part model: its reduced form
decides the order, its full form states the intervals.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from hexapod_doe.records.findings import TwoPart
from hexapod_doe.records.results import Analysis, Interval, Prediction


@dataclass(frozen=True)
class Standing:
    """One set by the model that decides, in original units."""

    rank: int
    label: str
    levels: Mapping[str, int]
    value: float
    """Expected response."""
    ci: Interval
    """Confidence interval of the mean."""
    pi: Interval
    """Prediction interval of one new training."""
    tested: bool
    alias_safe: bool

    @property
    def size(self) -> int:
        """How many factors the set has at their high level."""
        return sum(level > 0 for level in self.levels.values())


def deciding_parts(analysis: Analysis) -> TwoPart | None:
    """Return the two-part model if the choice is made from it."""
    return None if analysis.options['article'] else analysis.two_part


def standings(analysis: Analysis) -> list[Standing]:
    """Return all sets, best first, by the model that decides."""
    parts = deciding_parts(analysis)
    if parts is None:
        return [_by_final(p) for p in analysis.ranked()]
    safe = None if analysis.attribution is None else set(analysis.attribution.safe)
    known = {p.label: p for p in analysis.predictions}
    return [
        Standing(
            rank=rank,
            label=label,
            levels=known[label].levels,
            value=parts.selected[label],
            ci=parts.expected[label].ci,
            pi=parts.run_interval[label],
            tested=known[label].tested,
            alias_safe=known[label].alias_safe if safe is None else label in safe,
        )
        for rank, label in enumerate(parts.ranking, start=1)
    ]


def all_alike(found: Sequence[Standing]) -> bool:
    """Tell whether the model predicts the same for every set, so that their order says nothing."""
    return found[0].value == found[-1].value


def _by_final(p: Prediction) -> Standing:
    return Standing(p.rank, p.label, p.levels, p.fit, p.ci, p.pi, p.tested, p.alias_safe)
