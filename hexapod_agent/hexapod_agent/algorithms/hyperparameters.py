# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Hyper-parameters of the learner, by section of article.yaml, which holds and explains them.

No torch here: the environment reads the same file as the learner.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Annotated, Literal

from annotated_types import Interval, MinLen

# What the values may be: far wider than anything sensible, but with these nothing divides by zero,
# waits for ever or is not a number.
_Count = Annotated[int, Interval(ge=1, le=10_000_000)]
_Episodes = Annotated[int, Interval(ge=0, le=1_000_000)]
_Rows = Annotated[int, Interval(ge=1, le=1_000_000_000)]
_Layers = Annotated[tuple[Annotated[int, Interval(ge=1, le=100_000)], ...], MinLen(1)]
_Factor = Annotated[float, Interval(ge=0.0, le=1e6)]
_PositiveFactor = Annotated[float, Interval(gt=0.0, le=1e6)]
_Share = Annotated[float, Interval(ge=0.0, le=1.0)]
_Value = Annotated[float, Interval(ge=-1e9, le=1e9)]


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
        layer_norm: Whether each hidden layer is normalised before its ReLU.
    """

    hidden: _Layers
    learning_rate: _Factor
    l2: _Factor
    gradient_threshold: _PositiveFactor
    preactivation_penalty: _Factor
    normalize_loss: bool
    layer_norm: bool


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
        layer_norm: Whether each hidden layer is normalised before its ReLU.
        twin: Whether there are two, the lesser of whose target values is learned from.
    """

    hidden: _Layers
    merge: Literal['add', 'append']
    initial_value: _Value
    learning_rate: _Factor
    l2: _Factor
    gradient_threshold: _PositiveFactor
    layer_norm: bool
    twin: bool


@dataclass(frozen=True)
class DdpgConfig:
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
        normalize_observations: Whether the networks take observations less their mean and over
            their standard deviation, of all that the run has observed so far.
    """

    batch_size: _Count
    buffer_size: _Rows
    discount: _Share
    n_step: _Count
    target_smoothing: _Share
    update_every: _Count
    update_ratio: _PositiveFactor
    reward_scale: _PositiveFactor
    normalize_observations: bool

    @property
    def group_size(self) -> int:
        """Updates of a group.

        Raises:
            ValueError: They are not a whole number.
        """
        # As written, not as stored: 0.1 of 10 steps is one update.
        updates = Fraction(str(self.update_ratio)) * self.update_every
        if updates.denominator != 1:
            raise ValueError(
                f'learner.ddpg.update_ratio is {self.update_ratio}, expected a multiple of '
                f'1/{self.update_every}: after each {self.update_every} steps '
                '(learner.ddpg.update_every) comes a whole number of updates, not '
                f'{float(updates):g}'
            )
        return updates.numerator


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

    attraction: _Factor
    sigma: _Factor
    mean: _Value
    decay: _Share
    sigma_min: _Factor


@dataclass(frozen=True)
class LearnerConfig:
    """What learns, and how.

    Attributes:
        algorithm: Whose sections count.
        actor: The policy's network and its training.
        critic: The action value's network and its training.
        ddpg: The update.
        noise: Exploration.
    """

    algorithm: Literal['ddpg']
    actor: ActorConfig
    critic: CriticConfig
    ddpg: DdpgConfig
    noise: NoiseConfig


@dataclass(frozen=True)
class TrainingConfig:
    """The run around the updates.

    Attributes:
        episodes: Episodes of a run.
        window: Last returns that the final average reward is the mean of.
        evaluation: Episodes without noise or learning after the last one of the training, from
            starts that are the same for every run; 0 for none.
        checkpoint_every: Episodes between two checkpoints.
        final_rate: Share of both learning rates that is left at the last of `episodes`, towards
            which they fall by the same amount after each; it lasts in episodes after that.
        precision: Arithmetic of an update. 'float32' is torch's default. 'float32_fast' takes
            the machine's fastest product of float32 matrices, which may round the factors
            where the machine has units for that. 'bfloat16' computes hidden layers so; the
            parameters, output layers, losses and optimisers stay float32, and so does acting.
    """

    episodes: _Count
    window: _Count
    evaluation: _Episodes
    checkpoint_every: _Count
    final_rate: _Factor
    precision: Literal['float32', 'float32_fast', 'bfloat16']
