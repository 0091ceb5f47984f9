# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The learners of a fleet as one stack of networks, on the device that has them."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from hexapod_agent.algorithms import ALGORITHMS
from hexapod_agent.fleet.crew import Crew, Job
from hexapod_agent.fleet.seat import Seat
from hexapod_agent.learning.numerics import set_numerics
from hexapod_agent.learning.training import problem_of
from hexapod_agent.specification.run_spec import ConfigError, RunSpec


class StackedLearners:
    """One `LearnerStack` with a slot per place, its inputs as wide as the widest observation.

    Args:
        config: Of every run, but for what it observes.
        observation_size: Numbers of the widest observation.
        places: Slots of the stack.
        crew: Draws the batches.
        device: Where the networks are.

    Raises:
        ConfigError: The algorithm has no stack.
    """

    def __init__(
        self, config: RunSpec, observation_size: int, places: int, crew: Crew, device: str
    ) -> None:
        stack = ALGORITHMS[config.learner.algorithm].stack
        if stack is None:
            raise ConfigError(
                f'learner.algorithm is {config.learner.algorithm}, which learns on the CPU alone'
            )
        problem = replace(problem_of(config), observation_size=observation_size)
        self._stack = stack(config.learner, problem, places, device)
        self.beat = self._stack.update_interval
        self._crew = crew
        self._seats: dict[int, Seat] = {}
        set_numerics(config.training.precision)

    def seat(self, seat: Seat) -> None:
        """Copy a trainer's networks into its place of the stack."""
        self._seats[seat.place] = seat
        self._stack.put(seat.place, seat.trainer.learner)

    def settle(self, seat: Seat) -> None:
        """Copy the networks back."""
        self._stack.take(seat.place, seat.trainer.learner)

    def act(self, seats: Sequence[Seat], actions: NDArray[np.float32]) -> None:
        """Compute all policies in one pass, and let each trainer explore.

        A run that is being evaluated plays its own networks, as it does alone.
        """
        for seat in (each for each in seats if each.player is not None):
            actions[seat.place] = seat.agent.observe(seat.observation, seat.outcome)
        seats = [seat for seat in seats if seat.player is None]
        for seat in seats:
            seat.attempt(partial(seat.trainer.store, seat.observation, seat.outcome))
        members = {
            seat.place: (seat.trainer.learner, seat.observation)
            for seat in seats
            if seat.fault is None
        }
        for place, action in self._stack.act(members).items():
            actions[place] = action
            self._seats[place].trainer.note_output()

    def learn(self, seats: Sequence[Seat]) -> list[Job]:
        """Begin the gradient steps that are due; a device is still at them at the return."""
        learning = (seat for seat in seats if seat.fault is None and seat.player is None)
        members = {seat.place: seat.trainer.learner for seat in learning}
        self._stack.begin_update(members, self._crew.run)
        return []

    def collect(self) -> None:
        """Fetch what the updates saw, which waits for them."""
        for place, metrics in self._stack.end_update().items():
            seat = self._seats[place]
            seat.attempt(partial(seat.trainer.note_updates, metrics))
