# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Replay buffer that stores each observation once: the next one is in the following row."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor


@dataclass(frozen=True)
class Batch:
    """Transitions for an update of each of several agents, or for several updates of one.

    Attributes:
        observation: (batches, batch, observation size).
        action: (batches, batch, action size).
        reward: Discounted sum of the next n rewards (batches, batch, 1).
        next_observation: Observation after them (batches, batch, observation size).
        bootstrap: Factor of the value at `next_observation` (batches, batch, 1); 0 after a fall.
    """

    observation: Tensor
    action: Tensor
    reward: Tensor
    next_observation: Tensor
    bootstrap: Tensor

    @staticmethod
    def empty(
        batches: int, batch: int, observation_size: int, action_size: int, dtype: torch.dtype,
        device: torch.device | str = 'cpu', pinned: bool = False,
    ) -> 'Batch':  # fmt: skip
        """Allocate the tensors of a batch; `pinned` ones copy to a device without waiting."""
        widths = (observation_size, action_size, 1, observation_size, 1)
        return Batch(
            *(
                torch.zeros(batches, batch, width, dtype=dtype, device=device, pin_memory=pinned)
                for width in widths
            )
        )

    def inner(self, index: int) -> 'Batch':
        """View of one batch (batch, ...), as a stack of one agent learns from it."""
        return Batch(*(tensor[index] for tensor in vars(self).values()))

    def part(self, batches: slice, observation_size: int) -> 'Batch':
        """View of some of the batches, the observations only so wide."""
        wide = slice(0, observation_size)
        return Batch(
            self.observation[batches, :, wide],
            self.action[batches],
            self.reward[batches],
            self.next_observation[batches, :, wide],
            self.bootstrap[batches],
        )


class ReplayBuffer:
    """Ring of the newest rows, one per observation.

    Row i holds an observation and, once it is known, the action taken there with its reward.
    The row after it holds the next observation. An episode's last row has no action. A row that
    is overwritten takes the transition that starts in it along; the one before was gone already.

    Args:
        capacity: Rows that are kept. Memory is touched only as rows are first written.
        observation_size: Numbers of an observation.
        action_size: Numbers of an action.
        discount: Discount factor per step.
        n_step: Rewards summed before the value of a later observation takes over.
    """

    def __init__(
        self,
        capacity: int,
        observation_size: int,
        action_size: int,
        discount: float,
        n_step: int = 1,
    ) -> None:
        self.capacity = capacity
        self._discount = discount
        self._n_step = n_step
        # numpy.zeros, unlike torch.zeros, leaves untouched pages to the operating system.
        self._observation = np.zeros((capacity, observation_size), np.float32)
        self._action = np.zeros((capacity, action_size), np.float32)
        self._reward = np.zeros(capacity, np.float32)
        self._terminated = np.zeros(capacity, bool)
        self._has_next = np.zeros(capacity, bool)
        self._starts = np.zeros(capacity, np.int64)  # ring of rows that start a transition
        self._first = 0  # oldest entry of _starts
        self._size = 0
        self._row = -1  # newest row
        self._rows = 0  # rows ever written, up to the capacity

    def __len__(self) -> int:
        """Count of complete transitions."""
        return self._size

    def begin(self, observation: NDArray[np.float32]) -> None:
        """Store the first observation of an episode."""
        row = (self._row + 1) % self.capacity
        if self._size and self._starts[self._first] == row:
            self._first = (self._first + 1) % self.capacity
            self._size -= 1
        self._observation[row] = observation
        self._has_next[row] = False
        self._terminated[row] = False
        self._row = row
        self._rows = max(self._rows, row + 1)

    def add(
        self,
        action: NDArray[np.float32],
        reward: float,
        next_observation: NDArray[np.float32],
        terminated: bool,
    ) -> None:
        """Store the step taken from the newest observation and where it led."""
        row = self._row
        self._action[row] = action
        self._reward[row] = reward
        self.begin(next_observation)
        self._has_next[row] = True
        self._terminated[row] = terminated
        self._starts[(self._first + self._size) % self.capacity] = row
        self._size += 1

    def sample(self, generator: np.random.Generator, batch: Batch) -> None:
        """Draw transitions uniformly, with replacement, for one batch after the other."""
        drawn = generator.integers(self._size, size=batch.reward.numel())
        rows = self._starts[(self._first + drawn) % self.capacity]
        reward, last, bootstrap = self._returns(rows)
        for out, source, index in (
            (batch.observation, self._observation, rows),
            (batch.action, self._action, rows),
            (batch.next_observation, self._observation, last),
        ):
            into = out.view(-1, out.shape[-1])
            torch.index_select(torch.from_numpy(source), 0, torch.from_numpy(index), out=into)
        batch.reward.view(-1).copy_(torch.from_numpy(reward))
        batch.bootstrap.view(-1).copy_(torch.from_numpy(bootstrap))

    def _returns(
        self, rows: NDArray[np.int64]
    ) -> tuple[NDArray[np.float32], NDArray[np.int64], NDArray[np.float32]]:
        """Rewards of up to n steps from the rows, the row they end in, the value's factor there.

        Fewer than n steps are summed where the episode, or what is known of it, ends earlier.
        """
        reward = self._reward[rows]
        factor = np.full(rows.size, self._discount, np.float32)
        terminated = self._terminated[rows]
        last = (rows + 1) % self.capacity
        for _ in range(self._n_step - 1):
            goes_on = self._has_next[last]
            reward += np.where(goes_on, factor * self._reward[last], 0.0)
            terminated |= goes_on & self._terminated[last]
            factor = np.where(goes_on, factor * np.float32(self._discount), factor)
            last = np.where(goes_on, (last + 1) % self.capacity, last)
        return reward, last, np.where(terminated, np.float32(0.0), factor)

    def state(self) -> dict[str, Any]:
        """Everything that `restore` needs, without the rows that were never written."""
        rows = self._rows
        return {
            'observation': torch.from_numpy(self._observation[:rows]),
            'action': torch.from_numpy(self._action[:rows]),
            'reward': torch.from_numpy(self._reward[:rows]),
            'terminated': torch.from_numpy(self._terminated[:rows]),
            'has_next': torch.from_numpy(self._has_next[:rows]),
            'starts': torch.from_numpy(self._starts[:rows]),
            'first': self._first,
            'size': self._size,
            'row': self._row,
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Take over what `state` gave, of a buffer with the same sizes."""
        rows = len(state['reward'])
        for name in ('observation', 'action', 'reward', 'terminated', 'has_next', 'starts'):
            getattr(self, f'_{name}')[:rows] = state[name].numpy()
        self._first, self._size, self._row = state['first'], state['size'], state['row']
        self._rows = rows
