# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Agents that can be evaluated: a trained one, and baselines that observe nothing."""

from collections.abc import Callable

import numpy as np
from hexapod_cpg.mapping import ACTION_SIZE
from numpy.typing import NDArray

from hexapod_agent.algorithms.ddpg.ddpg import Ddpg
from hexapod_agent.algorithms.ddpg.layers import NORM_EPSILON

Policy = Callable[[NDArray[np.float32]], NDArray[np.float32]]


def constant_policy(action: NDArray[np.float32]) -> Policy:
    """Make an agent that always does the same; zeros are a straight walk."""
    return lambda observation: action


def random_policy(seed: int) -> Policy:
    """Make an agent that draws every action from U(-1, 1)."""
    generator = np.random.default_rng(seed)
    return lambda observation: generator.uniform(-1.0, 1.0, ACTION_SIZE).astype(np.float32)


def trained_policy(agent: Ddpg) -> Policy:
    """Make an agent that acts as the actor of a stack of one says now, without noise.

    It computes in numpy on the actor's own memory: for one observation torch takes several times
    as long, and rounds as the precision of the updates says.
    """
    arrays = {name: array[0].numpy() for name, array in agent.actor_parameters.arrays.items()}
    normalize = agent.actor_config.layer_norm
    *hidden, output = [
        (weight, arrays[name.replace('weight', 'bias')])
        for name, weight in arrays.items()
        if name.endswith('.weight')
    ]

    def act(observation: NDArray[np.float32]) -> NDArray[np.float32]:
        features = agent.scale.scaled(observation) if agent.scale else observation
        for weight, bias in hidden:
            features = weight @ features + bias
            if normalize:
                features -= features.mean()
                features /= np.sqrt(features @ features / features.size + NORM_EPSILON)
            features = np.maximum(features, 0.0)
        action: NDArray[np.float32] = np.tanh(output[0] @ features + output[1])
        return action

    return act
