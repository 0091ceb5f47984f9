# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""When algorithms with a replay buffer learn: a group of updates after every so many steps."""

from fractions import Fraction
from typing import Protocol


class GroupedUpdates(Protocol):
    """A section of a specification that says how often there are updates.

    Attributes:
        batch_size: Transitions per update.
        buffer_size: Observations that the replay buffer keeps.
        update_every: Steps between two groups of updates. Steps at the end of an episode that
            fill no group go into the buffer alone.
        update_ratio: Updates per step; those of a group are a whole number.
    """

    @property
    def batch_size(self) -> int: ...  # noqa: D102
    @property
    def buffer_size(self) -> int: ...  # noqa: D102
    @property
    def update_every(self) -> int: ...  # noqa: D102
    @property
    def update_ratio(self) -> float: ...  # noqa: D102


def group_size(name: str, section: GroupedUpdates) -> int:
    """Return the updates of a group.

    Args:
        name: Of the section, below `learner`.
        section: Its values.

    Raises:
        ValueError: They are not a whole number.
    """
    # As written, not as stored: 0.1 of 10 steps is one update.
    updates = Fraction(str(section.update_ratio)) * section.update_every
    if updates.denominator != 1:
        raise ValueError(
            f'learner.{name}.update_ratio is {section.update_ratio}, expected a multiple of '
            f'1/{section.update_every}: after each {section.update_every} steps '
            f'(learner.{name}.update_every) comes a whole number of updates, not '
            f'{float(updates):g}'
        )
    return updates.numerator


def check_groups(name: str, section: GroupedUpdates, episode_steps: int) -> None:
    """Refuse groups of updates and batches that no run of such episodes comes to.

    Args:
        name: Of the section, below `learner`.
        section: Its values.
        episode_steps: Actions of the longest episode.

    Raises:
        ValueError: They are such; the text names the keys.
    """
    if section.update_every > episode_steps:
        raise ValueError(
            f'learner.{name}.update_every is {section.update_every}, expected at most '
            f'task.time_limit_steps, {episode_steps}: nothing would be learned'
        )
    if section.buffer_size <= section.batch_size:
        raise ValueError(
            f'learner.{name}.buffer_size is {section.buffer_size}, expected more than '
            f'learner.{name}.batch_size, {section.batch_size}: nothing would be learned'
        )
