# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Sections of a specification that no package below has."""

from dataclasses import dataclass
from typing import Literal

from hexapod_cpg.mapping import ActionRanges
from hexapod_cpg.oscillator import HopfConfig

from hexapod_agent.algorithms.ranges import Count, CountOrNone, PositiveFactor


@dataclass(frozen=True)
class CpgConfig:
    """The pattern generator and what an action asks of it.

    Attributes:
        hopf: Constants of the oscillators.
        reading: Which command fields the five actions of a leg set.
        ranges: What action zero and action one stand for.
    """

    hopf: HopfConfig
    reading: Literal['D1', 'D2']
    ranges: ActionRanges


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
            which they fall by the same factor after each; it lasts in episodes after that.
        precision: Arithmetic of an update. 'float32' is torch's default. 'float32_fast' takes
            the machine's fastest product of float32 matrices, which may round the factors
            where the machine has units for that. 'bfloat16' computes hidden layers so; the
            parameters, output layers, losses and optimisers stay float32, and so does acting.
            'auto' is 'bfloat16' where processor and algorithm compute with it, and 'float32_fast'
            elsewhere: where a run begins it becomes one of the two.
    """

    episodes: Count
    window: Count
    evaluation: CountOrNone
    checkpoint_every: Count
    final_rate: PositiveFactor
    precision: Literal['float32', 'float32_fast', 'bfloat16', 'auto']
