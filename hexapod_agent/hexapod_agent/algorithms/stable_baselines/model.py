# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A model of stable-baselines3 without its environment and its loop: networks and updates.

Everything random comes from generators of the learner's own. Where the library draws from torch's
global generator while it learns, a learner has that be of no effect.
"""

import threading
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import numpy as np
import torch
from gymnasium.spaces import Box
from numpy.typing import NDArray
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.logger import Logger
from torch import nn

from hexapod_agent.algorithms.learner import Metrics, Problem
from hexapod_agent.algorithms.policies import MlpPolicy

M = TypeVar('M', bound=BaseAlgorithm)

# Networks are drawn from torch's global generator, which is lent to one model at a time.
_MAKING = threading.Lock()


def completed(model: M, problem: Problem, seed: int) -> M:
    """Return a model, made without an environment, with its networks.

    Args:
        model: Made with `_init_setup_model=False`, as the library itself does to load one.
        problem: Sizes.
        seed: Of the networks.
    """
    model.observation_space = Box(-1.0, 1.0, (problem.observation_size,), np.float32)
    model.action_space = Box(-1.0, 1.0, (problem.action_size,), np.float32)
    model.n_envs = 1
    with _MAKING, torch.random.fork_rng(devices=[]):
        torch.default_generator.manual_seed(seed)
        model._setup_model()
    model.set_logger(Logger(folder=None, output_formats=[]))
    return model


def rate_schedule(rate: float) -> Callable[[float], float]:
    """Return what gives the learning rate where so much of it is left."""
    return lambda share: rate * share


def set_rate_share(model: BaseAlgorithm, share: float) -> None:
    """Let the next updates learn at so much of the learning rate."""
    model._current_progress_remaining = share


def torch_generator(sequence: np.random.SeedSequence) -> torch.Generator:
    """Return a generator that is seeded from a stream of numpy's."""
    return torch.Generator().manual_seed(int_seed(sequence))


def int_seed(sequence: np.random.SeedSequence) -> int:
    """Return a stream of numpy's as one number."""
    return int(sequence.generate_state(1, np.uint64)[0])


def fill_bias(module: nn.Module, value: float) -> None:
    """Let the last affine layer of a module put out so much more at first."""
    *_, last = (each for each in module.modules() if isinstance(each, nn.Linear))
    with torch.no_grad():
        last.bias.add_(value)


Array = NDArray[np.float32]


def layers_of(*modules: nn.Module) -> tuple[tuple[Array, Array], ...]:
    """Return weight and bias of each affine layer in modules, on their own memory."""
    inner = (each for module in modules for each in module.modules())
    layers = [each for each in inner if isinstance(each, nn.Linear)]
    return tuple((array_of(layer.weight), array_of(layer.bias)) for layer in layers)


def array_of(parameter: torch.Tensor) -> Array:
    """Return a parameter as an array on its own memory."""
    array: Array = parameter.detach().numpy()
    return array


def policy_of(*modules: nn.Module, squash: bool = True) -> MlpPolicy:
    """Return a policy on the memory of a network's modules, in the order of its layers."""
    return MlpPolicy(layers_of(*modules), squash=squash)


class Seen:
    """What the updates of a model have logged last, by the names of a learner's metrics.

    TD3 logs no loss of the actor in a group without an update of it: the one before holds.

    Attributes:
        values: The metrics, once there are.
    """

    def __init__(self, model: BaseAlgorithm, names: Mapping[str, str]) -> None:
        """Begin with none.

        Args:
            model: That logs.
            names: The library's by the metrics'.
        """
        self._model, self._names = model, names
        self.values: dict[str, float] = {}

    def metrics(self, updates: int) -> Metrics:
        """Return the metrics of as many updates as the model has just taken."""
        logged = self._model.logger.name_to_value
        self.values |= {
            name: float(logged[key]) for name, key in self._names.items() if key in logged
        }
        return {name: np.full(updates, value) for name, value in self.values.items()}


def state_of(model: BaseAlgorithm) -> dict[str, Any]:
    """Return parameters, optimisers and count of updates."""
    _, variables = model._get_torch_save_params()
    return {
        'parameters': model.get_parameters(),
        'variables': {name: getattr(model, name).detach() for name in variables},
        'updates': model._n_updates,
    }


def restore(model: BaseAlgorithm, state: Mapping[str, Any]) -> None:
    """Take over what `state_of` gave, of a model with the same configuration."""
    model.set_parameters(state['parameters'], device='cpu')
    for name, value in state['variables'].items():
        getattr(model, name).data.copy_(value)
    model._n_updates = state['updates']
