# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Counts, over simulated campaigns, how often intervals cover and choices are right."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import pandas as pd

from hexapod_doe.records.findings import Bounds

STATED = 'stated'
COMPARED = 'for comparison'


@dataclass
class Tally:
    """Shares of covered targets and outcomes of choices, one value per campaign."""

    coverage: dict[tuple[str, str, float], list[float]] = field(default_factory=dict)
    """By kind, interval and nominal confidence."""
    choices: dict[str, list[tuple[float, float]]] = field(default_factory=dict)
    """Regret and whether it is the best set, by rule."""
    claims: dict[str, list[tuple[float, float]]] = field(default_factory=dict)
    """Probability claimed and whether it came true, by claim."""

    def cover(
        self, kind: str, name: str, level: float, bounds: Sequence[Bounds], target: np.ndarray
    ) -> None:
        """Add the share of targets that lie within their bounds; missing bounds don't count."""
        hits = [
            low <= value <= high
            for (low, high), value in zip(bounds, target, strict=True)
            if low is not None and high is not None
        ]
        self.coverage.setdefault((kind, name, level), []).append(float(np.mean(hits)))

    def coverage_table(self) -> pd.DataFrame:
        """Return mean coverage and its Monte Carlo error by interval."""
        rows = [
            (kind, name, level, np.mean(shares), np.std(shares) / np.sqrt(len(shares)))
            for (kind, name, level), shares in self.coverage.items()
        ]
        return pd.DataFrame(rows, columns=['kind', 'interval', 'nominal', 'coverage', 'error'])

    def choice_table(self) -> pd.DataFrame:
        """Return mean regret and the share of best picks by rule."""
        rows = [
            (name, *np.mean(values, axis=0), np.std([v[0] for v in values]) / np.sqrt(len(values)))
            for name, values in self.choices.items()
        ]
        return pd.DataFrame(rows, columns=['rule', 'regret', 'best', 'regret error'])

    def claim_table(self) -> pd.DataFrame:
        """Return the mean probability claimed and how often the claim was true."""
        rows = [(name, *np.mean(values, axis=0)) for name, values in self.claims.items()]
        return pd.DataFrame(rows, columns=['claim', 'claimed', 'true'])
