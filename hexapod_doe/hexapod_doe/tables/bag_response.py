# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Numbers that a training run can be judged by: what `analyze --response` offers for bags."""

from collections.abc import Callable, Iterable, Mapping

import numpy as np
import pandas as pd
from hexapod_agent.learning.metrics import RECOVERED

from hexapod_doe.bags.run_record import RunRecord
from hexapod_doe.errors import AnalysisError, BagError
from hexapod_doe.fitting.estimands import estimand

ARTICLE_RESPONSE = 'final_average_reward'
EVALUATION_RESPONSE = 'evaluation_return'
TERM_PREFIX, EVALUATION_PREFIX = 'term_', 'evaluation_'
_NAMED = 3


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


def _evaluation_return(run: RunRecord) -> float:
    """Mean return of the evaluation, as the agent kept it."""
    return float(_evaluation(run)['average_return'].iloc[-1])


def _evaluation_falls(run: RunRecord) -> float:
    """Episodes of the evaluation that ended by a failure."""
    return float(_evaluation(run)['terminated'].sum())


RESPONSES: Mapping[str, Callable[[RunRecord], float]] = {
    EVALUATION_RESPONSE: _evaluation_return,
    'evaluation_falls': _evaluation_falls,
    ARTICLE_RESPONSE: _final_average,
    'best_average_reward': _best_average,
    'final_iqm_reward': _final_iqm,
    'mean_return': _mean_return,
}
"""Responses by name. A reward term, such as `term_velocity`, is one as well: see `response_of`."""


def default_response(runs: Iterable[RunRecord]) -> str:
    """Return what runs are judged by where nothing else is asked for.

    That is their evaluation, or what the article judges by if none has one.

    Raises:
        AnalysisError: Some have one, and others have not.
    """
    runs = list(runs)
    without = [run.run_id for run in runs if run.evaluation.empty]
    if without and len(without) < len(runs):
        more = f' and {len(without) - _NAMED} more' if len(without) > _NAMED else ''
        raise AnalysisError(
            f'{len(without)} of {len(runs)} runs have no evaluation '
            f'({", ".join(without[:_NAMED])}{more}), expected one response of all: give '
            f'--response {ARTICLE_RESPONSE}, which each has, or have these trained anew'
        )
    return ARTICLE_RESPONSE if without else EVALUATION_RESPONSE


def response_of(run: RunRecord, name: str) -> float:
    """Return a run's response.

    Args:
        run: What its bag holds.
        name: A key of `RESPONSES`, or a reward term, of which the mean over the last `window`
            episodes is taken, or, after `evaluation_`, over those of the evaluation; of a varied
            robot `evaluation_recovered`, the share of them in which it walks again.

    Raises:
        AnalysisError: There is no such response.
        BagError: The run's metadata lack the window that the response is taken over.
    """
    if name in RESPONSES:
        return RESPONSES[name](run)
    terms = terms_of(run)
    if name in terms:
        return float(_last(run, name).mean())
    judged = judged_of(run)
    if name in judged:
        return float(_evaluation(run)[judged[name]].mean())
    known = ', '.join([*RESPONSES, *terms, *judged])
    raise AnalysisError(f'response {name!r}: run {run.run_id} has {known}')


def terms_of(run: RunRecord) -> list[str]:
    """Return the names of a run's reward terms."""
    return [str(column) for column in run.episodes if str(column).startswith(TERM_PREFIX)]


def judged_of(run: RunRecord) -> dict[str, str]:
    """Return columns of a run's evaluation by the responses that are their means."""
    columns = terms_of(run)
    if RECOVERED in run.evaluation and run.evaluation[RECOVERED].notna().all():
        columns.append(RECOVERED)
    return {f'{EVALUATION_PREFIX}{column}': column for column in columns}


def _evaluation(run: RunRecord) -> pd.DataFrame:
    if run.evaluation.empty:
        raise AnalysisError(
            f'run {run.run_id} has no evaluation, expected one: give '
            f'--response {ARTICLE_RESPONSE}, or have it trained anew'
        )
    return run.evaluation


def _last(run: RunRecord, column: str) -> pd.Series:
    return run.episodes[column].iloc[-_window(run) :]


def _window(run: RunRecord) -> int:
    if 'window' not in run.metadata:
        raise BagError(f'run {run.run_id}: its metadata lacks the window of the average')
    return int(run.metadata['window'])
