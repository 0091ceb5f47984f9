# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""DDPG's section of a specification; article.yaml holds and explains every value."""

from dataclasses import dataclass
from typing import Literal

from hexapod_agent.algorithms.learner import LearnerConfig
from hexapod_agent.algorithms.noise import NoiseConfig
from hexapod_agent.algorithms.ranges import (
    Count,
    CountOrNone,
    Factor,
    Layers,
    PositiveFactor,
    Rows,
    Share,
    Value,
)
from hexapod_agent.algorithms.update_groups import check_groups, group_size


@dataclass(frozen=True)
class ActorConfig:
    """The policy and its training.

    Attributes:
        hidden: Units of the hidden layers.
        learning_rate: Adam's step size.
        l2: Factor of the L2 term in the gradient, weights only.
        gradient_threshold: Largest L2 norm of an array's gradient.
        preactivation_penalty: Weight c of the loss term c mean(z²), z the output before tanh.
        normalize_loss: Whether the loss's value term is divided by mean |Q| of the batch.
        waits: Updates that the critic learns alone; the actor follows at the next episode.
    """

    hidden: Layers
    learning_rate: Factor
    l2: Factor
    gradient_threshold: PositiveFactor
    preactivation_penalty: Factor
    normalize_loss: bool
    waits: CountOrNone


@dataclass(frozen=True)
class CriticConfig:
    """The action value and its training.

    Attributes:
        hidden: Units of the observation branch; the action branch has as many as its last layer.
        merge: How the branches meet.
        initial_value: Value that every action in every state has at first: the output's bias.
        learning_rate: Adam's step size.
        l2: Factor of the L2 term in the gradient, weights only.
        gradient_threshold: Largest L2 norm of an array's gradient.
    """

    hidden: Layers
    merge: Literal['add', 'append']
    initial_value: Value
    learning_rate: Factor
    l2: Factor
    gradient_threshold: PositiveFactor


@dataclass(frozen=True)
class UpdateConfig:
    """The update.

    Attributes:
        batch_size: Transitions per update.
        buffer_size: Observations that the replay buffer keeps.
        discount: Discount factor per step.
        n_step: Rewards summed before the value of a later observation takes over.
        target_smoothing: Share of the online network that moves into its target per update.
        update_every: Steps between two groups of updates. Steps at the end of an episode that
            fill no group go into the buffer alone.
        update_ratio: Updates per step; those of a group are a whole number.
        reward_scale: Factor of the reward as the critic learns it.
    """

    batch_size: Count
    buffer_size: Rows
    discount: Share
    n_step: Count
    target_smoothing: Share
    update_every: Count
    update_ratio: PositiveFactor
    reward_scale: PositiveFactor

    @property
    def group_size(self) -> int:
        """Updates of a group.

        Raises:
            ValueError: They are not a whole number.
        """
        return group_size('ddpg', self)


@dataclass(frozen=True)
class DdpgConfig(LearnerConfig):
    """The article's learner.

    Attributes:
        actor: The policy's network and its training.
        critic: The action value's network and its training.
        ddpg: The update.
        noise: Exploration.
    """

    has_bfloat16 = True
    actor: ActorConfig
    critic: CriticConfig
    ddpg: UpdateConfig
    noise: NoiseConfig

    def check(self) -> None:
        """Refuse a group of updates that is no whole number."""
        _ = self.ddpg.group_size

    def check_training(self, episode_steps: int) -> None:
        """Refuse groups of updates and batches that no run of such episodes comes to."""
        check_groups('ddpg', self.ddpg, episode_steps)
