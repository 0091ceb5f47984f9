# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Lenth's test of effects without an estimate of error, for unreplicated designs.

R. V. Lenth, "Quick and easy analysis of unreplicated factorials", Technometrics 31 (1989).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy import stats

from hexapod_doe.errors import AnalysisError


@dataclass(frozen=True)
class Lenth:
    """Pseudo standard error of the effects and the margins beyond which one stands out."""

    s0: float
    pse: float
    df: float
    margin: float
    """ME: the margin for one effect."""
    simultaneous_margin: float
    """SME: the margin for all effects at once."""
    active: tuple[str, ...]
    """Effects beyond ME."""
    clearly_active: tuple[str, ...]
    """Effects beyond SME."""


def lenth(effects: Mapping[str, float], alpha: float = 0.05) -> Lenth:
    """Apply Lenth's method to the effects (not coefficients) of a saturated fit.

    Raises:
        AnalysisError: There are fewer than three effects.
    """
    if len(effects) < 3:
        raise AnalysisError(f"{len(effects)} effects: Lenth's method needs three at least")
    sizes = np.abs(list(effects.values()))
    s0 = 1.5 * float(np.median(sizes))
    inert = sizes[sizes < 2.5 * s0]
    pse = 1.5 * float(np.median(inert)) if len(inert) else 0.0
    df = len(sizes) / 3
    simultaneous = (1 + (1 - alpha) ** (1 / len(sizes))) / 2
    margin = float(stats.t.ppf(1 - alpha / 2, df)) * pse
    simultaneous_margin = float(stats.t.ppf(simultaneous, df)) * pse

    def beyond(limit: float) -> tuple[str, ...]:
        return tuple(term for term, effect in effects.items() if abs(effect) > limit)

    return Lenth(
        s0, pse, df, margin, simultaneous_margin, beyond(margin), beyond(simultaneous_margin)
    )
