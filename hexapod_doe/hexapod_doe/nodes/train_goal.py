# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Rows of a campaign as goals for workers."""

from diagnostic_msgs.msg import KeyValue
from hexapod_interfaces.action import TrainRun

from hexapod_doe.campaigns.row import Row


def train_goal(row: Row, record_every: int) -> TrainRun.Goal:
    """Return the goal that trains a row, or goes on with what was begun of it.

    Args:
        row: of a plan.
        record_every: every how many episodes all topics are recorded; 0 for never.
    """
    return TrainRun.Goal(
        run_id=row.run_id,
        spec=row.spec.to_text(),
        seed=row.seed,
        bag=str(row.bag),
        record_every=record_every,
        resume=True,
        metadata=[KeyValue(key=key, value=value) for key, value in row.metadata.items()],
    )
