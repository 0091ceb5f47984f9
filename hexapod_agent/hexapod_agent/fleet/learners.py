# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The learners of a fleet as networks apart, which learn bit by bit what each learns alone."""

from collections.abc import Sequence
from functools import partial
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hexapod_agent.fleet.crew import Crew, Job
from hexapod_agent.fleet.seat import Seat
from hexapod_agent.learning.numerics import set_numerics


class Learners(Protocol):
    """Who chooses the actions of a fleet and learns from what they earn."""

    beat: int
    """Episodes begin at multiples of so many periods, where that lets all learn at once."""

    def seat(self, seat: Seat) -> None:
        """Take over the networks of a trainer that takes its seat."""

    def settle(self, seat: Seat) -> None:
        """Bring a trainer's own networks up to date, so that it can be saved or evaluated."""

    def act(self, seats: Sequence[Seat], actions: NDArray[np.float32]) -> None:
        """Show each trainer its observation, and write what it does to its row of actions."""

    def learn(self, seats: Sequence[Seat]) -> list[Job]:
        """Begin the gradient steps that are due; return jobs that are left, for any order."""

    def collect(self) -> None:
        """Wait for the gradient step, and tell the trainers what it saw."""


class SeparateLearners:
    """Each trainer computes with its own networks, one job each: the way to learn on a CPU.

    There, stacked products are no faster than one after another, and not the same to the last bit.
    """

    beat = 1

    def __init__(self, crew: Crew) -> None:
        self._crew = crew

    def seat(self, seat: Seat) -> None:
        """Nothing to take over: the trainer's networks are the ones that learn."""

    def settle(self, seat: Seat) -> None:
        """Nothing to bring up to date."""

    def act(self, seats: Sequence[Seat], actions: NDArray[np.float32]) -> None:
        """Let each trainer act by itself."""

        def act(seat: Seat) -> None:
            actions[seat.place] = seat.agent.observe(seat.observation, seat.outcome)

        self._crew.run(partial(seat.attempt, partial(act, seat)) for seat in seats)

    def learn(self, seats: Sequence[Seat]) -> list[Job]:
        """Return one job per trainer."""
        return [partial(seat.attempt, partial(_learn, seat)) for seat in seats]

    def collect(self) -> None:
        """Nothing to wait for: the jobs were all."""


def _learn(seat: Seat) -> None:
    set_numerics(seat.trainer.config.training.precision)  # of this thread, and of this run
    seat.agent.learn()
