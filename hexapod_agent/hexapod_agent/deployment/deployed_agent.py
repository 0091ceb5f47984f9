# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A trained agent at work on a robot: from readings to commands, without rewards or episodes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from hexapod_cpg.mapping import ACTION_SIZE, Command, command_from_action
from numpy.typing import NDArray

from hexapod_agent.algorithms.policies import Policy
from hexapod_agent.deployment import agent_file
from hexapod_agent.specification.run_spec import RunSpec


class DeployedAgent:
    """Acts by a policy that stays as it is, and remembers its last action.

    Attributes:
        spec: What it observes.
        config: What it was trained with.
    """

    def __init__(self, config: RunSpec, policy: Policy) -> None:
        self.spec = config.observed
        self.config = config
        self._policy = policy
        self._action = np.zeros(ACTION_SIZE, dtype=np.float32)

    @classmethod
    def load(cls, path: str | Path, changes: str = '') -> DeployedAgent:
        """Read an agent's file.

        Args:
            path: File of `train`.
            changes: File of changes to the agent's specification; empty for none.

        Raises:
            ValueError: A file cannot be used; the text names it.
        """
        agent = agent_file.load(path)
        config = agent.config.changed_by(changes) if changes else agent.config
        return cls(config, agent.policy)

    def act(self, readings: Mapping[str, NDArray[np.float64]]) -> Command:
        """Return the command of one control period.

        Args:
            readings: By key of the sensor table, in its units.

        Raises:
            ObservationError: A reading is missing, has the wrong length, or is not finite.
        """
        self._action = self._policy(self.spec.assemble(readings, self._action))
        return command_from_action(self._action, self.config.cpg.reading, self.config.cpg.ranges)
