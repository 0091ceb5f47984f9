# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Kinds of campaigns that the study of coverage simulates: how runs come about, and which."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from hexapod_doe.designs.design import fraction
from hexapod_doe.fitting.model import corners
from simulated import Truth, repeated_levels

_NEVER = {'1': -50.0}
_PLACKETT_BURMAN = (1, 1, -1, 1, 1, 1, -1, -1, -1, 1, -1)
"""First row of the design in 12 cases; the next ten shift it, the last is all -1 (1946)."""


@dataclass(frozen=True)
class Scenario:
    """One kind of campaign."""

    truth: Truth
    levels: pd.DataFrame
    """Levels of all runs (n rows)."""
    blocks: np.ndarray | None = None
    """Block of each run (n,)."""
    article: bool = False
    """Judge the article's procedure as well, which drops three runs of ten."""


def _repeated(runs: pd.DataFrame, replicates: np.ndarray | int) -> pd.DataFrame:
    return runs.loc[runs.index.repeat(replicates)].reset_index(drop=True)


def _quarter(truth: Truth, replicates: int = 10, article: bool = False) -> Scenario:
    return Scenario(truth, repeated_levels(fraction('quarter'), replicates), article=article)


def _unequal_runs() -> Scenario:
    design = fraction('quarter')
    cases = pd.DataFrame(design.levels, columns=list(design.factors))
    return Scenario(Truth(), _repeated(cases, 3 + np.arange(len(cases)) * 5 % 8))


def _plackett_burman() -> Scenario:
    rows = [np.roll(_PLACKETT_BURMAN, shift) for shift in range(11)] + [np.full(11, -1)]
    cases = pd.DataFrame(np.array(rows)[:, :6], columns=list('ABCDEF'))
    truth = Truth(success={'1': 400, 'A': 50, 'B': 10, 'DE': 40}, failure=_NEVER)
    return Scenario(truth, _repeated(cases, 4))


def _curvature_in_blocks() -> Scenario:
    corner = corners('ABCD')
    centre = pd.DataFrame(0, index=range(3), columns=corner.columns)
    day = pd.concat([corner, centre], ignore_index=True)
    truth = Truth(
        success={'1': 400, 'A': 30, 'B': 20, 'AB': 10, 'curvature': 60},
        failure=_NEVER, sigma=20.0, block_sigma=30.0,
    )  # fmt: skip
    return Scenario(truth, pd.concat([day] * 4, ignore_index=True), np.repeat(range(4), len(day)))


SCENARIOS: dict[str, Callable[[], Scenario]] = {
    'failures': lambda: _quarter(Truth(), article=True),
    'no-failures': lambda: _quarter(Truth(failure=_NEVER), article=True),
    'two-runs': lambda: _quarter(Truth(), 2),
    'unequal-runs': _unequal_runs,
    'failure-interaction': lambda: _quarter(
        replace(Truth(), failure={'1': -1.3, 'B': -0.3, 'C': -0.3, 'BC': 1.0})
    ),
    'unequal-spread': lambda: _quarter(replace(Truth(), failure=_NEVER, log_spread={'C': 0.5})),
    'plackett-burman': _plackett_burman,
    'curvature-in-blocks': _curvature_in_blocks,
}
"""Name -> how to make it."""
