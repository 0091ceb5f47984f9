# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The learners of a fleet as one stack of networks, on the device that has them.

Replay buffers, exploration noise and bookkeeping stay with each trainer, and so does the order of
its random numbers: a stack learns what its trainers learn apart, but for the rounding of sums.
"""

from collections.abc import Sequence
from functools import partial

import numpy as np
import torch
from hexapod_cpg.mapping import ACTION_SIZE
from numpy.typing import NDArray

from hexapod_agent.algorithms.ddpg.ddpg import Ddpg, UpdateStatistics
from hexapod_agent.algorithms.replay import Batch
from hexapod_agent.fleet.crew import Crew, Job
from hexapod_agent.fleet.seat import Seat
from hexapod_agent.specification.run_spec import RunSpec


class StackedLearners:
    """One `Ddpg` with an agent per place, its inputs as wide as the widest observation.

    Args:
        config: Of every run.
        observation_size: Numbers of the widest observation; narrower ones are filled with zeros.
        places: Agents of the stack.
        crew: Draws the batches.
        device: Where the networks are.
    """

    def __init__(
        self, config: RunSpec, observation_size: int, places: int, crew: Crew, device: str
    ) -> None:
        learner, wide = config.learner, torch.float32
        ddpg = learner.ddpg
        self.beat, self._updates = ddpg.update_every, ddpg.group_size
        narrow = torch.bfloat16 if config.training.precision == 'bfloat16' else None
        self._crew = crew
        self._device = torch.device(device)
        self._stack = Ddpg(
            observation_size, ACTION_SIZE, learner.actor, learner.critic, ddpg.batch_size,
            ddpg.target_smoothing, None, places, wide, narrow, self._device,
        )  # fmt: skip
        pinned = self._device.type != 'cpu'
        # A group of updates for the first place, then one for the second, and so on.
        sizes = (places * self._updates, ddpg.batch_size, observation_size, ACTION_SIZE, wide)
        self._drawn = Batch.empty(*sizes, pinned=pinned)
        self._sent = Batch.empty(*sizes, self._device)
        self._batches = [self._batch_of(update, places) for update in range(self._updates)]
        self._observations = torch.zeros(places, observation_size, pin_memory=pinned)
        self._learning: tuple[int, ...] = ()
        self._pending: tuple[list[Seat], list[UpdateStatistics]] | None = None

    def _batch_of(self, update: int, places: int) -> Batch:
        """View of what all places learn from in one update of a group, as the stack takes it."""
        place = 0 if places == 1 else slice(None)
        groups = (
            tensor.unflatten(0, (places, self._updates)) for tensor in vars(self._sent).values()
        )
        return Batch(*(group[place, update] for group in groups))

    def _drawn_for(self, seat: Seat) -> Batch:
        """View of what one place learns from in a group of updates."""
        first = seat.place * self._updates
        return self._drawn.part(slice(first, first + self._updates), seat.trainer.spec.size)

    def seat(self, seat: Seat) -> None:
        """Copy a trainer's networks into its place of the stack."""
        self._stack.put(seat.place, seat.trainer.agent)
        self._observations[seat.place].zero_()
        for drawn in vars(self._drawn).values():
            drawn.unflatten(0, (-1, self._updates))[seat.place].zero_()

    def settle(self, seat: Seat) -> None:
        """Copy the networks back."""
        self._stack.take(seat.place, seat.trainer.agent)

    def act(self, seats: Sequence[Seat], actions: NDArray[np.float32]) -> None:
        """Compute all policies in one pass, and let each trainer add its noise.

        A run that is being evaluated plays its own networks, as it does alone.
        """
        for seat in (each for each in seats if each.player is not None):
            actions[seat.place] = seat.agent.observe(seat.observation, seat.outcome)
        seats = [seat for seat in seats if seat.player is None]
        for seat in seats:
            seat.attempt(partial(seat.trainer.store, seat.observation, seat.outcome))
            row = self._observations[seat.place, : seat.observation.size]
            scale = seat.trainer.agent.scale
            inputs = scale.scaled(seat.observation) if scale else seat.observation
            row.copy_(torch.from_numpy(inputs))
        observations = self._observations.to(self._device, non_blocking=True)
        outputs = self._stack.act(observations).cpu().numpy()
        for seat in seats:
            if seat.fault is None:
                actions[seat.place] = seat.trainer.explore(outputs[seat.place])

    def learn(self, seats: Sequence[Seat]) -> list[Job]:
        """Begin the gradient steps that are due; a device is still at them at the return."""
        learning = (seat for seat in seats if seat.fault is None and seat.player is None)
        due = [seat for seat in learning if seat.trainer.due]
        if not due:
            return []
        places = tuple(seat.place for seat in due)
        if places != self._learning:
            self._learning = places
            self._stack.learn_only(places)
        for seat in due:
            self._stack.set_rate_share(seat.trainer.rate_share, seat.place)
        self._crew.run(partial(self._draw, seat) for seat in due)
        for here, there in zip(vars(self._drawn).values(), vars(self._sent).values(), strict=True):
            there.copy_(here, non_blocking=True)
        self._pending = due, [self._stack.update(batch) for batch in self._batches]
        return []

    def _draw(self, seat: Seat) -> None:
        seat.trainer.sample(self._drawn_for(seat))

    def collect(self) -> None:
        """Fetch the statistics of the updates, which waits for them."""
        if self._pending is None:
            return
        seats, updates = self._pending
        self._pending = None
        names = tuple(vars(updates[0]))
        rows = torch.stack([torch.stack(tuple(vars(each).values()), dim=1) for each in updates])
        for update in rows.tolist():  # by place, by name
            for seat in seats:
                values = dict(zip(names, update[seat.place], strict=True))
                seat.attempt(partial(seat.trainer.note_update, values))
