# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Test of a model against the pure error of repeated runs.

Montgomery, Design and Analysis of Experiments, 8th ed., section 10.8.
"""

from dataclasses import dataclass

import numpy as np
from scipy import linalg, stats
from statsmodels.regression.linear_model import OLS, RegressionResults


@dataclass(frozen=True)
class LackOfFit:
    """Test of the model against the pure error of repeated runs."""

    ss_lack_of_fit: float
    df_lack_of_fit: int
    ss_pure_error: float
    df_pure_error: int
    f: float
    p: float


def lack_of_fit(
    result: RegressionResults, case: np.ndarray, parameters: int, blocks: np.ndarray
) -> LackOfFit | None:
    """Return the lack-of-fit test, or None without repeated runs or without spare case.

    Args:
        result: The fit of the model.
        case: Number of each row's case, from 0 (n,).
        parameters: Terms of the model.
        blocks: Basis of the differences between blocks (n, b); pure error is free of them.
    """
    cells = np.eye(int(case.max()) + 1)[case]
    within = linalg.orth(blocks - cells @ (cells.T @ blocks / cells.sum(axis=0)[:, None]))
    whole = OLS(result.model.endog, np.column_stack([cells, within]), hasconst=True).fit()
    pure, df_pure = float(whole.ssr), int(whole.df_resid)
    df_lack = len(case) - parameters - blocks.shape[1] - df_pure
    if df_pure < 1 or df_lack < 1 or pure <= 0:
        return None
    lack = max(float(result.ssr) - pure, 0.0)
    f = (lack / df_lack) / (pure / df_pure)
    return LackOfFit(lack, df_lack, pure, df_pure, f, float(stats.f.sf(f, df_lack, df_pure)))
