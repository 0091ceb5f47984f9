# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the figures of a training mean: the same names in bags, TensorBoard files and reports."""

import pandas as pd
from hexapod_agent.learning import metrics

from hexapod_doe.records.results import Analysis
from hexapod_doe.reporting.tables import Table

_OF_AN_EPISODE = {
    'episode_return': 'sum of the rewards of an episode, exploration noise included',
    'average_return': 'mean of the last returns, over at most `training.window` episodes',
    'final_average_reward': 'average_return after the last episode: the article’s response',
    'evaluation_return': 'mean return without noise, after the training, from starts that all '
    'runs share: the response where the bags have it',
    'steps': 'control periods until the episode ended, 600 for a whole one of 15 s',
    'terminated': 'whether it ended by a failure; `cause` says which, or time_limit',
    'term_velocity': 'speed along the line',
    'term_closeness': 'closeness to the line; negative beyond 1 m',
    'term_orientation': 'cost of roll, of pitch and of yaw against the line',
    'term_height': 'cost of leaving the walking height',
    'term_alive': 'constant of every step',
    'late, missing, duplicate, out_of_order': 'departures from lock-step: 0 in a healthy run',
}


def meanings() -> dict[str, str]:
    """Return the meaning of what a bag has of an episode, by name; the learner's metrics last."""
    return _OF_AN_EPISODE | {
        metric.name: metric.meaning + (f', in {metric.unit}' if metric.unit != '1' else '')
        for metric in metrics.METRICS
    }


def glossary(analysis: Analysis) -> Table | None:
    """Tabulate the meanings, where the runs come from bags."""
    if analysis.curves.empty:
        return None
    cells = {'name': list(meanings()), 'meaning': list(meanings().values())}
    return Table(
        'glossary', 'What the figures of a training mean',
        'Names as in the bags. Terms are sums over an episode; they add up to its return.',
        cells, pd.DataFrame(cells),
    )  # fmt: skip
