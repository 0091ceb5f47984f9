# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Inputs of the networks scaled by the mean and deviation of what a run has observed so far."""

from collections.abc import Mapping

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from hexapod_agent.algorithms.policies import SCALED_LIMIT, scaled

_LEAST_DEVIATION = 0.02  # of a number within +-1: one that hardly changes is not blown up


class RunningScale:
    """Scale of observations: (observation - center) gain, within +-`SCALED_LIMIT`.

    It stays as it is during an episode, so that a policy does not change under way.

    Attributes:
        center: Mean of what was observed (size,).
        gain: One over its standard deviation (size,).
    """

    def __init__(self, size: int) -> None:
        """Begin with no scaling."""
        self.center = np.zeros(size, np.float32)
        self.gain = np.ones(size, np.float32)
        self._sums = np.zeros((3, size))  # count, sum, sum of squares

    def add(self, observation: NDArray[np.float32]) -> None:
        """Take an observation (size,) into account, from the next `refresh` on."""
        self._sums[0] += 1.0
        self._sums[1] += observation
        self._sums[2] += observation.astype(np.float64) ** 2

    def refresh(self) -> None:
        """Scale by all that was added from now on."""
        count, total, squares = self._sums
        if not count[0]:
            return
        mean = total / count
        variance = np.maximum(squares / count - mean**2, _LEAST_DEVIATION**2)
        self.center[:] = mean
        self.gain[:] = 1.0 / np.sqrt(variance)

    def scaled(self, observation: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return an observation (size,) as the networks take it."""
        return scaled(observation, self.center, self.gain)

    def scale(self, observations: Tensor) -> None:
        """Scale observations (..., size) in place."""
        observations.sub_(torch.from_numpy(self.center))
        observations.mul_(torch.from_numpy(self.gain)).clamp_(-SCALED_LIMIT, SCALED_LIMIT)

    def state_dict(self) -> dict[str, Tensor]:
        """What it takes to scale, and to go on."""
        arrays = {'center': self.center, 'gain': self.gain, 'sums': self._sums}
        return {name: torch.from_numpy(array) for name, array in arrays.items()}

    def load_state_dict(self, state: Mapping[str, Tensor]) -> None:
        """Take over what `state_dict` gave, or, to scale alone, its `center` and `gain`."""
        for name, value in self.state_dict().items():
            if name in state:
                value.copy_(state[name])
