# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Sections of a specification for TD3, SAC and PPO, without their library.

Values that no comment explains are those of the algorithm's paper or of the library; where they
differ, the library's.
"""

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Interval

from hexapod_agent.algorithms.learner import LearnerConfig
from hexapod_agent.algorithms.noise import NoiseConfig
from hexapod_agent.algorithms.ranges import (
    Count,
    Factor,
    Layers,
    PositiveFactor,
    Rows,
    Share,
    Value,
)
from hexapod_agent.algorithms.update_groups import check_groups, group_size

_ARTICLE_LAYERS = (400, 300)
_DISCOUNT = 0.99
_REWARD_SCALE = 0.1
_INITIAL_VALUE = 530.0  # article.yaml's critic; from the library's 0 it takes 10,000 updates
_DEVIATION = 0.3  # the library's 1 would fill the range of an action


@dataclass(frozen=True)
class OffPolicySection:
    """What TD3 and SAC share: networks, the replay buffer and when there are updates.

    Attributes:
        hidden: Units of the hidden layers, of the actor and of both critics.
        learning_rate: Adam's step size, of all that is learned.
        batch_size: Transitions per update.
        buffer_size: Observations that the replay buffer keeps.
        discount: Discount factor per step.
        n_step: Rewards summed before the value of a later observation takes over.
        target_smoothing: Share of the online networks that moves into their targets.
        update_every: Steps between two groups of updates.
        update_ratio: Updates per step; those of a group are a whole number.
        reward_scale: Factor of the reward as the critics learn it.
        initial_value: Value that every action in every state has at first, in rewards as they are.
    """

    hidden: Layers = _ARTICLE_LAYERS
    learning_rate: Factor = 3e-4
    batch_size: Count = 256
    buffer_size: Rows = 1_000_000
    discount: Share = _DISCOUNT
    n_step: Count = 1
    target_smoothing: Share = 0.005
    update_every: Count = 24  # one stride, as DDPG's
    update_ratio: PositiveFactor = 1.0
    reward_scale: PositiveFactor = _REWARD_SCALE
    initial_value: Value = _INITIAL_VALUE


@dataclass(frozen=True)
class Td3Section(OffPolicySection):
    """The update of TD3 (Fujimoto et al. 2018).

    Attributes:
        learning_rate: Adam's step size, of all networks.
        policy_delay: Updates of the critics for each one of the actor and the targets.
        target_noise: Standard deviation of the noise on the target's action.
        target_noise_limit: Where that noise is clipped.
    """

    learning_rate: Factor = 1e-3
    policy_delay: Count = 2
    target_noise: Factor = 0.2
    target_noise_limit: Factor = 0.5


@dataclass(frozen=True)
class SacSection(OffPolicySection):
    """The update of SAC with a learned temperature (Haarnoja et al. 2018, 1812.05905).

    Attributes:
        temperature: Weight of the entropy at first.
        target_entropy: Entropy of the policy that the temperature is learned for, per number of
            the action.
        deviation: Standard deviation of an action before tanh, at first.
    """

    temperature: PositiveFactor = 0.1
    target_entropy: Annotated[float, Interval(ge=-100.0, le=100.0)] = -1.0
    deviation: PositiveFactor = _DEVIATION


@dataclass(frozen=True)
class PpoSection:
    """The update of PPO (Schulman et al. 2017).

    Attributes:
        hidden: Units of the hidden layers, of the policy and of the value.
        learning_rate: Adam's step size.
        rollout_steps: Steps between two updates; they go on over the ends of episodes.
        batch_size: Steps of a gradient step.
        epochs: Passes over the steps of an update.
        discount: Discount factor per step.
        trace: Lambda of the generalised advantage estimation.
        clip_range: Change of an action's likelihood ratio beyond which nothing is gained.
        entropy_weight: Weight of the entropy in the loss.
        value_weight: Weight of the value's error in the loss.
        gradient_threshold: Largest L2 norm of the gradient, of all arrays together.
        reward_scale: Factor of the reward as the value learns it.
        initial_value: Value that every state has at first, in rewards as they are.
        deviation: Standard deviation of an action at first.
    """

    hidden: Layers = _ARTICLE_LAYERS
    learning_rate: Factor = 3e-4
    rollout_steps: Count = 2400  # four whole episodes, and 2048 in round numbers
    batch_size: Count = 100
    epochs: Count = 10
    discount: Share = _DISCOUNT
    trace: Share = 0.95
    clip_range: PositiveFactor = 0.2
    entropy_weight: Factor = 0.0
    value_weight: Factor = 0.5
    gradient_threshold: PositiveFactor = 0.5
    reward_scale: PositiveFactor = _REWARD_SCALE
    initial_value: Value = _INITIAL_VALUE
    deviation: PositiveFactor = _DEVIATION


@dataclass(frozen=True)
class Td3Config(LearnerConfig):
    """TD3; it explores by the noise of the article's DDPG.

    Attributes:
        noise: Exploration.
        td3: The update.
    """

    noise: NoiseConfig
    td3: Td3Section = Td3Section()

    def check(self) -> None:
        """Refuse a group of updates that is no whole number."""
        group_size('td3', self.td3)

    def check_training(self, episode_steps: int) -> None:
        """Refuse groups of updates and batches that no run of such episodes comes to."""
        check_groups('td3', self.td3, episode_steps)


@dataclass(frozen=True)
class SacConfig(LearnerConfig):
    """SAC; it explores by its policy's own spread.

    Attributes:
        sac: The update.
    """

    sac: SacSection = SacSection()

    def check(self) -> None:
        """Refuse a group of updates that is no whole number."""
        group_size('sac', self.sac)

    def check_training(self, episode_steps: int) -> None:
        """Refuse groups of updates and batches that no run of such episodes comes to."""
        check_groups('sac', self.sac, episode_steps)


@dataclass(frozen=True)
class PpoConfig(LearnerConfig):
    """PPO; it explores by its policy's own spread.

    Attributes:
        ppo: The update.
    """

    ppo: PpoSection = PpoSection()

    def check(self) -> None:
        """Refuse gradient steps of which one would have a single step, or none."""
        ppo = self.ppo
        if ppo.batch_size < 2 or ppo.rollout_steps % ppo.batch_size:
            raise ValueError(
                f'learner.ppo.rollout_steps is {ppo.rollout_steps}, expected a multiple of '
                f'learner.ppo.batch_size, {ppo.batch_size}, which is to be at least 2'
            )
