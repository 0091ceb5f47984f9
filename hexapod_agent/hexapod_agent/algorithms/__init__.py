# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What learns: a file, or a folder, and a row of `ALGORITHMS` for each algorithm."""

from dataclasses import dataclass
from pkgutil import resolve_name

from hexapod_agent.algorithms.learner import Learner, LearnerConfig, LearnerStack


@dataclass(frozen=True)
class Algorithm:
    """Where an algorithm's classes are, as 'module:name': only what is used is imported.

    Attributes:
        config_path: Its `LearnerConfig`.
        learner_path: Its `Learner`.
        stack_path: Its `LearnerStack`; '' if it has none and trains on the CPU only.
    """

    config_path: str
    learner_path: str
    stack_path: str = ''

    @property
    def config(self) -> type[LearnerConfig]:
        """Its section of a specification."""
        found: type[LearnerConfig] = resolve_name(self.config_path)
        return found

    @property
    def learner(self) -> type[Learner]:
        """What learns."""
        found: type[Learner] = resolve_name(self.learner_path)
        return found

    @property
    def stack(self) -> type[LearnerStack[Learner]] | None:
        """What many of them are computed as, if anything."""
        return resolve_name(self.stack_path) if self.stack_path else None


ALGORITHMS = {
    'ddpg': Algorithm(
        'hexapod_agent.algorithms.ddpg.config:DdpgConfig',
        'hexapod_agent.algorithms.ddpg.learner:DdpgLearner',
        'hexapod_agent.algorithms.ddpg.stack:DdpgStack',
    ),
    'td3': Algorithm(
        'hexapod_agent.algorithms.stable_baselines.config:Td3Config',
        'hexapod_agent.algorithms.stable_baselines.td3:Td3Learner',
    ),
    'sac': Algorithm(
        'hexapod_agent.algorithms.stable_baselines.config:SacConfig',
        'hexapod_agent.algorithms.stable_baselines.sac:SacLearner',
    ),
    'ppo': Algorithm(
        'hexapod_agent.algorithms.stable_baselines.config:PpoConfig',
        'hexapod_agent.algorithms.stable_baselines.ppo:PpoLearner',
    ),
}
