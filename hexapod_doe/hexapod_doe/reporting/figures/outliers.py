# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which values lie far from the others, so that a figure can name them."""

from typing import Any

import pandas as pd

_FENCE = 1.5


def outliers(values: 'pd.Series[float]') -> list[Any]:
    """Return the labels of values beyond 1.5 interquartile ranges of the quartiles (Tukey)."""
    low, high = values.quantile([0.25, 0.75])
    reach = _FENCE * (high - low)
    return list(values.index[(values < low - reach) | (values > high + reach)])
