# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Numbers that a training run can be judged by: what `analyze --response` offers for bags."""

from collections.abc import Callable, Mapping

import numpy as np
import pandas as pd

from hexapod_doe.bags.run_record import RunRecord
from hexapod_doe.errors import AnalysisError, BagError
from hexapod_doe.fitting.estimands import estimand

DEFAULT_RESPONSE = 'final_average_reward'
TERM_PREFIX = 'term_'


def _final_average(run: RunRecord) -> float:
    """Mean of the last `window` returns, as the agent kept it."""
    return float(run.episodes['average_return'].iloc[-1])


def _best_average(run: RunRecord) -> float:
    """Highest mean of `window` returns in a row; of all returns if there are fewer."""
    returns = run.episodes['episode_return']
    width = min(_window(run), len(returns))
    return float(returns.rolling(width).mean().max())


def _final_iqm(run: RunRecord) -> float:
    """Mean of the middle half of the last `window` returns."""
    last = np.sort(_last(run, 'episode_return').to_numpy(float))
    return float(last @ estimand('iqm').weights(len(last)))


def _mean_return(run: RunRecord) -> float:
    """Mean of all returns: the area under the learning curve, per episode."""
    return float(run.episodes['episode_return'].mean())


RESPONSES: Mapping[str, Callable[[RunRecord], float]] = {
    DEFAULT_RESPONSE: _final_average,
    'best_average_reward': _best_average,
    'final_iqm_reward': _final_iqm,
    'mean_return': _mean_return,
}
"""Responses by name. A reward term, such as `term_velocity`, is one as well: see `response_of`."""


def response_of(run: RunRecord, name: str = DEFAULT_RESPONSE) -> float:
    """Return a run's response.

    Args:
        run: What its bag holds.
        name: A key of `RESPONSES`, or a reward term, of which the mean over the last `window`
            episodes is taken.

    Raises:
        AnalysisError: There is no such response.
        BagError: The run's metadata lack the window that the response is taken over.
    """
    if name in RESPONSES:
        return RESPONSES[name](run)
    terms = [str(column) for column in run.episodes if str(column).startswith(TERM_PREFIX)]
    if name not in terms:
        known = ', '.join([*RESPONSES, *terms])
        raise AnalysisError(f'response {name!r}: run {run.run_id} has {known}')
    return float(_last(run, name).mean())


def _last(run: RunRecord, column: str) -> pd.Series:
    return run.episodes[column].iloc[-_window(run) :]


def _window(run: RunRecord) -> int:
    if 'window' not in run.metadata:
        raise BagError(f'run {run.run_id}: its metadata lacks the window of the average')
    return int(run.metadata['window'])
