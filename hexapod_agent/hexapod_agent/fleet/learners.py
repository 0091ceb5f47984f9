# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The learners of a fleet as networks apart, which learn bit by bit what each learns alone."""

from collections.abc import Sequence
from functools import partial
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hexapod_agent.fleet.pool import Job, Pool
from hexapod_agent.fleet.slot import Slot
from hexapod_agent.learning.numerics import set_numerics


class Learners(Protocol):
    """Who chooses the actions of a fleet and learns from what they earn."""

    update_interval: int
    """Episodes begin at multiples of so many periods, where that lets all learn at once."""

    def admit(self, slot: Slot) -> None:
        """Take over the networks of a trainer that is admitted."""

    def sync(self, slot: Slot) -> None:
        """Bring a trainer's own networks up to date, so that it can be saved or evaluated."""

    def act(self, slots: Sequence[Slot], actions: NDArray[np.float32]) -> None:
        """Show each trainer its observation, and write what it does to its row of actions."""

    def learn(self, slots: Sequence[Slot]) -> list[Job]:
        """Begin the gradient steps that are due; return jobs that are left, for any order."""

    def collect(self) -> None:
        """Wait for the gradient step, and tell the trainers what it saw."""


class SeparateLearners:
    """Each trainer computes with its own networks, one job each: the way to learn on a CPU.

    There, stacked products are no faster than one after another, and not the same to the last bit.
    """

    update_interval = 1

    def __init__(self, pool: Pool) -> None:
        self._pool = pool

    def admit(self, slot: Slot) -> None:
        """Nothing to take over: the trainer's networks are the ones that learn."""

    def sync(self, slot: Slot) -> None:
        """Nothing to bring up to date."""

    def act(self, slots: Sequence[Slot], actions: NDArray[np.float32]) -> None:
        """Let each trainer act by itself."""

        def act(slot: Slot) -> None:
            actions[slot.index] = slot.agent.observe(slot.observation, slot.outcome)

        self._pool.run(partial(slot.guard, partial(act, slot)) for slot in slots)

    def learn(self, slots: Sequence[Slot]) -> list[Job]:
        """Return one job per trainer."""
        return [partial(slot.guard, partial(_learn, slot)) for slot in slots]

    def collect(self) -> None:
        """Nothing to wait for: the jobs were all."""


def _learn(slot: Slot) -> None:
    set_numerics(slot.trainer.config.training.precision)  # of this thread, and of this run
    slot.agent.learn()
