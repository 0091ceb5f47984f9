# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What learners report of an episode: one table of names, units, meanings and plots.

Results on the wire, bags, TensorBoard files, layouts, reports and pages follow from it. A learner
may report a name that is not here: it is carried and shown as it is.
"""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Metric:
    """A number of an episode.

    Attributes:
        name: In results, bags and files.
        unit: SI, or 1.
        meaning: In one line.
        plot: Title of the layouts' plot that shows it; '' for none. Equal titles share axes.
    """

    name: str
    unit: str
    meaning: str
    plot: str = ''


# A layout finds a value by its place: what is new goes to the end.
METRICS = (
    Metric(
        'critic_loss', '1', 'mean squared error of the value against its target, over the updates'
    ),
    Metric('actor_loss', '1', 'what the actor minimises, over the updates'),
    Metric(
        'mean_q', '1', 'value that the critic gives the actor’s own actions, over the updates',
        plot='mean Q',
    ),
    Metric('saturated_share', '1', 'share of the actor’s outputs beyond 0.95 of their range'),
    Metric('updates', '1', 'gradient steps of the episode'),
    Metric(
        'late_speed', 'm/s', 'in the evaluation of a varied robot: speed along the line over the '
        'last 8 s, as the reward counts it'
    ),
    Metric(
        'recovered', '1', 'in the evaluation of a varied robot: 1 if it did not fail and its late '
        'speed is half of that of the robot as it was built, else 0'
    ),
)  # fmt: skip
SATURATED_SHARE, UPDATES = 'saturated_share', 'updates'
"""What every agent reports."""
LATE_SPEED, RECOVERED = 'late_speed', 'recovered'
"""What the evaluation of a varied robot reports."""


def in_order(values: Mapping[str, float]) -> dict[str, float]:
    """Return values by name: those of the table first, in its order, NaN where there is none."""
    known = dict.fromkeys((metric.name for metric in METRICS), float('nan'))
    return known | dict(values)
