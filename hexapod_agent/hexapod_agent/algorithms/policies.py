# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Policies: what algorithms learn, and baselines that observe nothing."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from hexapod_cpg.mapping import ACTION_SIZE
from numpy.typing import NDArray

Array = NDArray[np.float32]
Policy = Callable[[Array], Array]


def constant_policy(action: Array) -> Policy:
    """Make an agent that always does the same; zeros are a straight walk."""
    return lambda observation: action


def random_policy(seed: int) -> Policy:
    """Make an agent that draws every action from U(-1, 1)."""
    generator = np.random.default_rng(seed)
    return lambda observation: generator.uniform(-1.0, 1.0, ACTION_SIZE).astype(np.float32)


@dataclass(frozen=True)
class MlpPolicy:
    """Affine layers with ReLU between them, within +-1 at the end; its arrays may be a learner's.

    It computes in numpy: for one observation torch takes several times as long, and rounds as the
    precision of the updates says.

    Attributes:
        layers: Weight (outputs, inputs) and bias (outputs,) of each layer.
        squash: Whether tanh brings the last layer within +-1; else it is clipped there.
    """

    layers: tuple[tuple[Array, Array], ...]
    squash: bool = True

    def __call__(self, observation: Array) -> Array:
        """Return the action for an observation."""
        return self.bounded(self.outputs(self.features(observation)))

    def features(self, observation: Array) -> Array:
        """Return what the last hidden layer makes of an observation."""
        features = observation
        for weight, bias in self.layers[:-1]:
            features = np.maximum(weight @ features + bias, 0.0)
        return features

    def outputs(self, features: Array) -> Array:
        """Return the last layer (action size,), before it is brought within +-1."""
        weight, bias = self.layers[-1]
        return weight @ features + bias

    def bounded(self, outputs: Array) -> Array:
        """Return the action of outputs of the last layer."""
        action: Array = np.tanh(outputs) if self.squash else outputs.clip(-1.0, 1.0)
        return action

    def to_mapping(self) -> dict[str, Any]:
        """Return what it is made of, as `from_mapping` takes it."""
        return {'layers': [list(layer) for layer in self.layers], 'squash': self.squash}

    @classmethod
    def from_mapping(cls, content: Mapping[str, Any]) -> 'MlpPolicy':
        """Make a policy of what `to_mapping` gave."""
        return cls(
            tuple((weight, bias) for weight, bias in content['layers']),
            content.get('squash', True),  # there was nothing else
        )
