# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Test of curvature at centre points, within blocks and by the model.

The indicator of the centre points stands in a regression with all terms that the runs can
estimate, so that neither unequal replicates nor blocks pass for curvature; its F equals the
textbook's (ȳ_F − ȳ_C)²·n_F·n_C/(n_F + n_C) over pure error where the runs are balanced.
Montgomery, Design and Analysis of Experiments, 8th ed., section 6.8.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from hexapod_doe.designs.terms import CURVATURE
from hexapod_doe.fitting.model import centre_points, estimable_terms
from hexapod_doe.fitting.regression import ols


@dataclass(frozen=True)
class Curvature:
    """Test of the centre points against what the factorial runs foretell for the centre."""

    difference: float
    """Fitted mean of the factorial runs at the centre minus that of the centre points."""
    ss: float
    df_error: int
    f: float | None
    p: float | None


def curvature(
    levels: pd.DataFrame, response: np.ndarray, blocks: np.ndarray | None = None
) -> Curvature | None:
    """Return the curvature test, or None without centre points or where blocks hide them.

    Args:
        levels: Coded levels of the runs (n rows).
        response: Their response (n,).
        blocks: Basis of the differences between blocks (n, b).
    """
    if not centre_points(levels).any():
        return None
    terms = estimable_terms(levels, None, blocks)
    if CURVATURE not in terms:
        return None
    fit = ols(levels, response, terms, blocks)
    index = terms.index(CURVATURE)
    coef = float(fit.coef[index])
    ss = coef**2 / float((fit.root[index] ** 2).sum())
    if fit.t is None or fit.p is None or fit.sse <= 0:
        return Curvature(-coef, ss, fit.df_error, None, None)
    return Curvature(-coef, ss, fit.df_error, float(fit.t[index] ** 2), float(fit.p[index]))
