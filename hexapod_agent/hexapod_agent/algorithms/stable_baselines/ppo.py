# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""PPO: gradient steps on what the policy has just done, within a trust region."""

from collections.abc import Generator, Mapping
from typing import Any, NamedTuple

import numpy as np
import torch
from hexapod_sim.task import Outcome
from numpy.typing import NDArray
from stable_baselines3 import PPO
from stable_baselines3.common.buffers import RolloutBuffer
from stable_baselines3.common.type_aliases import RolloutBufferSamples
from torch import nn

from hexapod_agent.algorithms.learner import Learner, Metrics, Problem
from hexapod_agent.algorithms.policies import MlpPolicy
from hexapod_agent.algorithms.stable_baselines.config import PpoConfig, PpoSection
from hexapod_agent.algorithms.stable_baselines.model import (
    Seen,
    array_of,
    completed,
    fill_bias,
    int_seed,
    policy_of,
    rate_schedule,
    restore,
    set_rate_share,
    state_of,
)

_LOGGED = {
    'critic_loss': 'train/value_loss',
    'actor_loss': 'train/policy_gradient_loss',
    'entropy_loss': 'train/entropy_loss',
    'approximate_kl': 'train/approx_kl',
    'clipped_share': 'train/clip_fraction',
    'deviation': 'train/std',
}
_FILLED = ('observations', 'actions', 'rewards', 'episode_starts')
_SHUFFLED = ('observations', 'actions', 'values', 'log_probs', 'advantages', 'returns')


class Rollout(RolloutBuffer):
    """The library's buffer, shuffled by a generator of one's own."""

    shuffle: np.random.Generator

    def get(self, batch_size: int | None = None) -> Generator[RolloutBufferSamples, None, None]:
        """Yield all steps in batches, in a new order."""
        if not self.generator_ready:
            for name in _SHUFFLED:
                setattr(self, name, self.swap_and_flatten(getattr(self, name)))
            self.generator_ready = True
        order = self.shuffle.permutation(self.buffer_size)
        size = batch_size or self.buffer_size
        for first in range(0, self.buffer_size, size):
            yield self._get_samples(order[first : first + size])


class Pending(NamedTuple):
    """The step that has begun: what was observed, and what was done."""

    observation: NDArray[np.float32]
    action: NDArray[np.float32]
    starts: bool
    """Whether an episode begins with it."""


class PpoLearner(Learner):
    """See `Learner`; it resumes to the last bit.

    Steps are collected over the ends of episodes. Values and likelihoods of a rollout are computed
    at its end, all at once. The step amid which a policy is updated counts to the next rollout,
    with the likelihood by which it was drawn.
    """

    metric_names = tuple(_LOGGED)

    def __init__(self, config: PpoConfig, problem: Problem, seed: int) -> None:
        ppo = self._ppo = config.ppo
        networks, exploration, shuffle = np.random.SeedSequence(seed).spawn(3)
        self._exploration = np.random.default_rng(exploration)
        self._shuffle = np.random.default_rng(shuffle)
        self._model = completed(_new_model(ppo), problem, int_seed(networks))
        self._rollout: RolloutBuffer = self._model.rollout_buffer
        assert isinstance(self._rollout, Rollout)
        self._rollout.shuffle = self._shuffle
        network = self._model.policy
        fill_bias(network.value_net, ppo.initial_value * ppo.reward_scale)
        self._policy = policy_of(
            network.mlp_extractor.policy_net, network.action_net, squash=False
        )
        self._log_deviation = array_of(network.log_std)
        self._seen = Seen(self._model, _LOGGED)
        self.output = np.zeros(problem.action_size, np.float32)
        self._pending: Pending | None = None
        self._observation, self._starts = np.zeros(problem.observation_size, np.float32), True
        self._cut: dict[int, NDArray[np.float32]] = {}
        """Last observations of episodes that time ended, by the row that led there."""
        self._whole = 0
        """Rows of complete episodes."""
        self._first: tuple[float, float] | None = None
        """Value and log-likelihood of row 0, where it was done before the last update."""

    def begin_episode(self, rate_share: float) -> None:
        """Begin an episode, without the steps of one that was left unfinished."""
        set_rate_share(self._model, rate_share)
        self._set_rows(self._whole)
        self._cut = {row: seen for row, seen in self._cut.items() if row < self._whole}
        if not self._whole:
            self._first = None
        self._pending, self._starts = None, True

    def _set_rows(self, rows: int) -> None:
        self._rollout.pos, self._rollout.full = rows, rows == self._ppo.rollout_steps

    def act(self, observation: NDArray[np.float32], explore: bool) -> NDArray[np.float32]:
        """Choose an action, drawn from the policy if it is to explore."""
        mean = self._policy.outputs(self._policy.features(observation))
        self.output = self._policy.bounded(mean)
        if not explore:
            return self.output
        drawn = self._exploration.standard_normal(mean.size, dtype=np.float32)
        action = (mean + np.exp(self._log_deviation) * drawn).astype(np.float32)
        self._pending = Pending(self._observation, action, self._starts)
        return self._policy.bounded(action)

    def store(self, observation: NDArray[np.float32], outcome: Outcome) -> None:
        """Add the step that ends in `observation`, or begin an episode with it."""
        if self._pending is not None:
            self._add(self._pending, outcome.reward * self._ppo.reward_scale)
            if outcome.truncated and not outcome.terminated:
                self._cut[self._rollout.pos - 1] = observation.copy()
        self._observation, self._starts = observation.copy(), self._pending is None
        if outcome.terminated or outcome.truncated:
            self._whole = self._rollout.pos

    def _add(self, step: Pending, reward: float) -> None:
        later = torch.zeros(1)  # `_evaluate` fills it in
        self._rollout.add(
            step.observation, step.action, np.array([reward]), np.array([step.starts]),
            later, later,
        )  # fmt: skip

    def update(self) -> Metrics:
        """Take all gradient steps of a rollout where it is full."""
        if not self._rollout.full or self._pending is None:
            return {}
        self._evaluate(self._pending)
        self._model.train()
        self._rollout.reset()
        self._whole, self._cut = 0, {}
        ppo = self._ppo
        return self._seen.metrics(ppo.epochs * (ppo.rollout_steps // ppo.batch_size))

    @torch.no_grad()
    def _evaluate(self, pending: Pending) -> None:
        """Fill in what the policy that is to be updated makes of the steps, and their returns."""
        rollout, policy = self._rollout, self._model.policy
        observations = np.concatenate((rollout.observations[:, 0], pending.observation[None]))
        actions = np.concatenate((rollout.actions[:, 0], pending.action[None]))
        values, likelihoods, _ = policy.evaluate_actions(
            torch.from_numpy(observations), torch.from_numpy(actions)
        )
        rollout.values[:] = values[:-1].numpy()
        rollout.log_probs[:, 0] = likelihoods[:-1].numpy()
        if self._first is not None:
            rollout.values[0], rollout.log_probs[0] = self._first
        for row, seen in self._cut.items():
            value = policy.predict_values(torch.from_numpy(seen[None]))
            rollout.rewards[row] += self._ppo.discount * value.numpy()[0]
        self._first = float(values[-1]), float(likelihoods[-1])
        rollout.compute_returns_and_advantage(values[-1], np.array([pending.starts]))

    def policy(self) -> MlpPolicy:
        """Return the mean of the policy, on its own memory."""
        return self._policy

    def state_dict(self) -> dict[str, Any]:
        """Return networks, optimiser, the rollout so far and random states."""
        rows = slice(self._whole)
        arrays = {name: getattr(self._rollout, name)[rows].copy() for name in _FILLED}
        return {
            'model': state_of(self._model),
            'seen': dict(self._seen.values),
            'exploration': self._exploration.bit_generator.state,
            'shuffle': self._shuffle.bit_generator.state,
            'rollout': {name: torch.from_numpy(array) for name, array in arrays.items()},
            'cut': {row: torch.from_numpy(seen) for row, seen in self._cut.items()},
            'first': None if self._first is None else list(self._first),
        }

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Take over what `state_dict` gave, of a learner with the same configuration."""
        restore(self._model, state['model'])
        self._seen.values = dict(state['seen'])
        self._exploration.bit_generator.state = state['exploration']
        self._shuffle.bit_generator.state = state['shuffle']
        self._rollout.reset()
        for name, rows in state['rollout'].items():
            getattr(self._rollout, name)[: len(rows)] = rows.numpy()
            self._whole = len(rows)
        self._set_rows(self._whole)
        self._cut = {row: seen.numpy() for row, seen in state['cut'].items()}
        self._first = None if state['first'] is None else (state['first'][0], state['first'][1])


def _new_model(ppo: PpoSection) -> PPO:
    """Return the library's PPO, without networks."""
    hidden = list(ppo.hidden)
    return PPO(
        'MlpPolicy', None, rate_schedule(ppo.learning_rate),  # type: ignore[arg-type]
        ppo.rollout_steps, ppo.batch_size, ppo.epochs, ppo.discount, ppo.trace, ppo.clip_range,
        ent_coef=ppo.entropy_weight, vf_coef=ppo.value_weight,
        max_grad_norm=ppo.gradient_threshold, rollout_buffer_class=Rollout, device='cpu',
        policy_kwargs={
            'net_arch': {'pi': hidden, 'vf': hidden}, 'activation_fn': nn.ReLU,
            'log_std_init': float(np.log(ppo.deviation)),
        },
        _init_setup_model=False,
    )  # fmt: skip
