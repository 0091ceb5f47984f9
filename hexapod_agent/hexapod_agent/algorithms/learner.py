# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a training asks of an algorithm: a learner, and a stack of them where there is one.

Order of calls, of a learner that is new or has taken over a state between two episodes:

    learner.begin_episode(rate_share)
    learner.store(observation, outcome)           the start, outcome.step 0
    while the episode goes on:
        action = learner.act(observation, explore=True)
        metrics = learner.update()                while the robot moves
        learner.store(observation, outcome)       what the action led to

An episode may be left unfinished: the next `begin_episode` drops it. All arrays are float32 unless
said otherwise, of one observation or action each; who keeps one copies it. All numbers follow from
the arguments, the seed and the order of calls: none from the clock, from threads or from what else
the process computes. A learner sets nothing global of a library; `numerics` does for a training.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol, TypeVar

import numpy as np
from hexapod_sim.task import Outcome
from numpy.typing import NDArray

from hexapod_agent.algorithms.policies import MlpPolicy

Metrics = Mapping[str, NDArray[np.float64]]
"""Numbers by name, each (updates,): one for each gradient step, in their order."""
Job = Callable[[], None]


@dataclass(frozen=True)
class Problem:
    """What is to be learned, in numbers.

    Attributes:
        observation_size: Numbers of an observation, each within +-1.
        action_size: Numbers of an action, each within +-1.
        period_s: Time from one action to the next.
        episode_steps: Actions of the longest episode.
        precision: Arithmetic of an update, as `TrainingConfig` says.
    """

    observation_size: int
    action_size: int
    period_s: float
    episode_steps: int
    precision: str


@dataclass(frozen=True)
class LearnerConfig:
    """An algorithm's section of a specification: a frozen dataclass of sections below this one.

    Values stand in article.yaml. A section that article.yaml lacks has its values as defaults.

    Attributes:
        algorithm: Name of a row of `ALGORITHMS`.
        has_bfloat16: Whether its updates can compute with `training.precision` bfloat16.
    """

    has_bfloat16: ClassVar[bool] = False
    algorithm: str

    def check(self) -> None:
        """Refuse values that are allowed, but not with one another.

        Raises:
            ValueError: They are such; the text names their keys.
        """

    def check_training(self, episode_steps: int) -> None:
        """Refuse values by which nothing would be learned.

        Args:
            episode_steps: Actions of the longest episode.

        Raises:
            ValueError: They are such; the text names their keys.
        """


class Learner(Protocol):
    """An agent that acts, remembers what that earned, and learns from it.

    Attributes:
        metric_names: Names of what `update` reports, a number per gradient step.
        output: What the policy put out at the last `act` (action_size,), before exploration.
    """

    metric_names: tuple[str, ...]
    output: NDArray[np.float32]

    def __init__(self, config: Any, problem: Problem, seed: int) -> None:
        """Make a learner that has seen nothing.

        Args:
            config: The algorithm's section of a specification.
            problem: Sizes and lengths.
            seed: Seed of everything random.

        Raises:
            ValueError: With this configuration it would learn nothing; the text names the keys.
        """

    def begin_episode(self, rate_share: float) -> None:
        """Begin an episode, at so much of the learning rates."""

    def act(self, observation: NDArray[np.float32], explore: bool) -> NDArray[np.float32]:
        """Choose the action (action_size,) within +-1 for an observation (observation_size,)."""

    def store(self, observation: NDArray[np.float32], outcome: Outcome) -> None:
        """Remember what the last action led to, or at step 0 where the episode begins.

        Both are finite; `outcome.terminated` says that no value follows.
        """

    def update(self) -> Metrics:
        """Take the gradient steps that are due, and return what they saw; {} if none was."""

    def policy(self) -> MlpPolicy:
        """Return what acts as `act` does without exploring, and goes on to as this learns."""

    def state_dict(self) -> dict[str, Any]:
        """Return tensors, numbers, text, dicts and lists of them that the future depends on.

        Between two episodes; a learner with the same arguments goes on from it to the last bit.
        """

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Take over what `state_dict` gave."""


L = TypeVar('L', bound=Learner, contravariant=True)


class LearnerStack(Protocol[L]):
    """Learners of one algorithm and configuration whose networks are computed as one, by slot.

    What they remember and draw stays with each learner. Sums are rounded otherwise than alone.

    Attributes:
        update_interval: Periods between updates; episodes that begin at multiples learn at once.
    """

    update_interval: int

    def __init__(self, config: Any, problem: Problem, slots: int, device: str) -> None:
        """Make a stack for observations of at most `problem.observation_size` numbers."""

    def put(self, slot: int, learner: L) -> None:
        """Take over a learner's networks."""

    def take(self, slot: int, learner: L) -> None:
        """Bring a learner's own networks up to date."""

    def act(
        self, members: Mapping[int, tuple[L, NDArray[np.float32]]]
    ) -> dict[int, NDArray[np.float32]]:
        """Choose an action for each slot's learner and observation, exploring, as `act` does."""

    def begin_update(self, members: Mapping[int, L], run: Callable[[Iterable[Job]], None]) -> None:
        """Begin the gradient steps that are due.

        Args:
            members: The learners that go on, by slot.
            run: Does jobs, maybe in threads, and waits for them.
        """

    def end_update(self) -> dict[int, Metrics]:
        """Wait for the gradient steps begun last; return what each slot's learner saw."""
