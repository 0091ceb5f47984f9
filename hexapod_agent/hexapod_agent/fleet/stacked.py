# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The learners of a fleet as one stack of networks, on the device that has them."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from hexapod_agent.algorithms import ALGORITHMS
from hexapod_agent.fleet.pool import Job, Pool
from hexapod_agent.fleet.slot import Slot
from hexapod_agent.learning.numerics import set_numerics
from hexapod_agent.learning.training import problem_of
from hexapod_agent.specification.run_spec import ConfigError, RunSpec


class StackedLearners:
    """One `LearnerStack` for all slots, its inputs as wide as the widest observation.

    Args:
        config: Of every run, but for what it observes.
        observation_size: Numbers of the widest observation.
        num_slots: Of the stack.
        pool: Draws the batches.
        device: Where the networks are.

    Raises:
        ConfigError: The algorithm has no stack.
    """

    def __init__(
        self, config: RunSpec, observation_size: int, num_slots: int, pool: Pool, device: str
    ) -> None:
        stack = ALGORITHMS[config.learner.algorithm].stack
        if stack is None:
            raise ConfigError(
                f'learner.algorithm is {config.learner.algorithm}, which learns on the CPU alone, '
                'expected --device cpu'
            )
        problem = replace(problem_of(config), observation_size=observation_size)
        self._stack = stack(config.learner, problem, num_slots, device)
        self.update_interval = self._stack.update_interval
        self._pool = pool
        self._slots: dict[int, Slot] = {}
        set_numerics(config.training.precision)

    def admit(self, slot: Slot) -> None:
        """Copy a trainer's networks into the stack."""
        self._slots[slot.index] = slot
        self._stack.put(slot.index, slot.trainer.learner)

    def sync(self, slot: Slot) -> None:
        """Copy the networks back."""
        self._stack.take(slot.index, slot.trainer.learner)

    def act(self, slots: Sequence[Slot], actions: NDArray[np.float32]) -> None:
        """Compute all policies in one pass, and let each trainer explore.

        A run that is being evaluated plays its own networks, as it does alone.
        """
        for slot in (each for each in slots if each.player is not None):
            actions[slot.index] = slot.agent.observe(slot.observation, slot.outcome)
        slots = [slot for slot in slots if slot.player is None]
        for slot in slots:
            slot.guard(partial(slot.trainer.store, slot.observation, slot.outcome))
        members = {
            slot.index: (slot.trainer.learner, slot.observation)
            for slot in slots
            if slot.fault is None
        }
        for index, action in self._stack.act(members).items():
            actions[index] = action
            self._slots[index].trainer.note_output()

    def learn(self, slots: Sequence[Slot]) -> list[Job]:
        """Begin the gradient steps that are due; a device is still at them at the return."""
        learning = (slot for slot in slots if slot.fault is None and slot.player is None)
        members = {slot.index: slot.trainer.learner for slot in learning}
        self._stack.begin_update(members, self._pool.run)
        return []

    def collect(self) -> None:
        """Fetch what the updates saw, which waits for them."""
        for index, metrics in self._stack.end_update().items():
            slot = self._slots[index]
            slot.guard(partial(slot.trainer.note_updates, metrics))
