# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ornstein-Uhlenbeck exploration noise in the form that MATLAB's DDPG agent uses."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexapod_agent.algorithms.ranges import Factor, Share, Value


@dataclass(frozen=True)
class NoiseConfig:
    """Ornstein-Uhlenbeck noise; MATLAB's names in brackets.

    Attributes:
        attraction: Pull towards the mean [MeanAttractionConstant], 1/s.
        sigma: Standard deviation of the drive [StandardDeviation], 1/sqrt(s).
        mean: Value that the noise is pulled to [Mean].
        decay: Share of sigma lost per step [StandardDeviationDecayRate].
        sigma_min: Least sigma [StandardDeviationMin].
    """

    attraction: Factor
    sigma: Factor
    mean: Value
    decay: Share
    sigma_min: Factor


class OrnsteinUhlenbeckNoise:
    """x <- x + theta (mean - x) Ts + sigma randn sqrt(Ts), sigma <- max(sigma (1 - decay), min).

    Attributes:
        value: Current noise (size,).
        sigma: Current standard deviation.
    """

    def __init__(
        self, config: NoiseConfig, size: int, sample_time: float, generator: np.random.Generator
    ) -> None:
        self._config = config
        self._sample_time = sample_time
        self._root = math.sqrt(sample_time)
        self._generator = generator
        self.sigma = config.sigma
        self.value = np.full(size, config.mean)

    def reset(self) -> None:
        """Start an episode at the mean; sigma goes on decaying over the training."""
        self.value = np.full_like(self.value, self._config.mean)

    def sample(self) -> NDArray[np.float64]:
        """Advance one step and return the new value (size,)."""
        config = self._config
        drive = self._generator.standard_normal(self.value.size)
        pull = config.attraction * (config.mean - self.value) * self._sample_time
        self.value = self.value + pull + self.sigma * self._root * drive
        self.sigma = max(self.sigma * (1.0 - config.decay), config.sigma_min)
        return self.value
