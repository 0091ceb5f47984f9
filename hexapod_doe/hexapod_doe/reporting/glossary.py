# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the figures of a training mean: the same names in bags, TensorBoard files and reports."""

import pandas as pd

from hexapod_doe.records.results import Analysis
from hexapod_doe.reporting.tables import Table

METRICS = {
    'episode_return': 'sum of the rewards of an episode, exploration noise included',
    'average_return': 'mean of the last returns, over at most `training.window` episodes',
    'final_average_reward': 'average_return after the last episode: the response of a run',
    'steps': 'control periods until the episode ended, 600 for a whole one of 15 s',
    'terminated': 'whether it ended by a failure; `cause` says which, or time_limit',
    'term_velocity': 'speed along the line',
    'term_closeness': 'closeness to the line; negative beyond 1 m',
    'term_orientation': 'cost of roll, of pitch and of yaw against the line',
    'term_height': 'cost of leaving the walking height',
    'term_alive': 'constant of every step',
    'critic_loss': 'mean squared error of the value against its target, over the updates',
    'actor_loss': 'what the actor minimises, over the updates',
    'mean_q': 'value that the critic gives the actor’s own actions, over the updates',
    'saturated_share': 'share of the actor’s outputs beyond 0.95 of their range',
    'updates': 'gradient steps of the episode',
    'late, missing, duplicate, out_of_order': 'departures from lock-step: 0 in a healthy run',
}
"""Name in a bag -> its meaning."""


def glossary(analysis: Analysis) -> Table | None:
    """Tabulate the meanings, where the runs come from bags."""
    if analysis.curves.empty:
        return None
    data = pd.DataFrame({'name': list(METRICS), 'meaning': list(METRICS.values())})
    cells = {'name': list(METRICS), 'meaning': list(METRICS.values())}
    return Table(
        'glossary', 'What the figures of a training mean',
        'Names as in the bags. Terms are sums over an episode; they add up to its return.',
        cells, data,
    )  # fmt: skip
