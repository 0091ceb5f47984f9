# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""DDPG learners whose networks are one stack, on the device that has them.

Replay buffers, exploration noise and the order of random numbers stay with each learner: a stack
learns what its learners learn apart, but for the rounding of sums.
"""

from collections.abc import Callable, Iterable, Mapping
from functools import partial

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from hexapod_agent.algorithms.ddpg.config import DdpgConfig
from hexapod_agent.algorithms.ddpg.ddpg import METRICS, Ddpg
from hexapod_agent.algorithms.ddpg.learner import DdpgLearner, compute_dtype
from hexapod_agent.algorithms.learner import Job, LearnerStack, Metrics, Problem
from hexapod_agent.algorithms.replay import Batch


class DdpgStack(LearnerStack[DdpgLearner]):
    """See `LearnerStack`; narrower observations than the widest are filled with zeros."""

    def __init__(self, config: DdpgConfig, problem: Problem, slots: int, device: str) -> None:
        ddpg = config.ddpg
        self.update_interval, self._updates = ddpg.update_every, ddpg.group_size
        self._device = torch.device(device)
        sizes = problem.observation_size, problem.action_size
        self._networks = Ddpg(
            *sizes, config, None, slots,
            compute_dtype=compute_dtype(problem.precision), device=self._device,
        )  # fmt: skip
        pinned = self._device.type != 'cpu'
        # A group of updates for the first slot, then one for the second, and so on.
        drawn = (slots * self._updates, ddpg.batch_size, *sizes, torch.float32)
        self._drawn = Batch.empty(*drawn, pinned=pinned)
        self._sent = Batch.empty(*drawn, self._device)
        self._batches = [self._batch_of(update, slots) for update in range(self._updates)]
        self._observations = torch.zeros(slots, sizes[0], pin_memory=pinned)
        self._learning: tuple[int, ...] = ()
        self._pending: list[tuple[Tensor, Tensor, Tensor]] = []

    def _batch_of(self, update: int, slots: int) -> Batch:
        """View of what all slots learn from in one update of a group, as the networks take it."""
        slot = 0 if slots == 1 else slice(None)
        groups = (
            tensor.unflatten(0, (slots, self._updates)) for tensor in vars(self._sent).values()
        )
        return Batch(*(group[slot, update] for group in groups))

    def put(self, slot: int, learner: DdpgLearner) -> None:
        """Copy a learner's networks into the stack."""
        self._networks.put(slot, learner.networks)
        self._observations[slot].zero_()
        for drawn in vars(self._drawn).values():
            drawn.unflatten(0, (-1, self._updates))[slot].zero_()

    def take(self, slot: int, learner: DdpgLearner) -> None:
        """Copy the networks back."""
        self._networks.take(slot, learner.networks)

    def act(
        self, members: Mapping[int, tuple[DdpgLearner, NDArray[np.float32]]]
    ) -> dict[int, NDArray[np.float32]]:
        """Compute all policies in one pass, and let each learner add its noise."""
        for slot, (_, observation) in members.items():
            self._observations[slot, : observation.size].copy_(torch.from_numpy(observation))
        observations = self._observations.to(self._device, non_blocking=True)
        outputs = self._networks.act(observations).cpu().numpy()
        return {slot: learner.explore(outputs[slot]) for slot, (learner, _) in members.items()}

    def begin_update(
        self, members: Mapping[int, DdpgLearner], run: Callable[[Iterable[Job]], None]
    ) -> None:
        """Begin the gradient steps that are due; a device is still at them at the return."""
        due = {slot: learner for slot, learner in members.items() if learner.due}
        if not due:
            return
        if (slots := tuple(due)) != self._learning:
            self._learning = slots
            self._networks.learn_only(slots)
        for slot, learner in due.items():
            self._networks.set_rate_shares(*learner.rate_shares, slot)
        run(partial(self._draw, slot, learner) for slot, learner in due.items())
        for here, there in zip(vars(self._drawn).values(), vars(self._sent).values(), strict=True):
            there.copy_(here, non_blocking=True)
        self._pending = [self._networks.update(batch) for batch in self._batches]

    def _draw(self, slot: int, learner: DdpgLearner) -> None:
        """Draw what a slot learns from in a group of updates."""
        first = slot * self._updates
        group = slice(first, first + self._updates)
        learner.sample(self._drawn.part(group, learner.problem.observation_size))

    def end_update(self) -> dict[int, Metrics]:
        """Fetch what the updates saw, which waits for them."""
        if not self._pending:
            return {}
        rows = torch.stack([torch.stack(seen) for seen in self._pending])
        self._pending = []
        seen = rows.cpu().double().numpy()  # by update, name and slot
        return {
            slot: dict(zip(METRICS, seen[:, :, slot].T, strict=True)) for slot in self._learning
        }
