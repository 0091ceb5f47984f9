# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The robots of a fleet: one batch of pattern generators, physics for each robot apart."""

import numpy as np
from hexapod_cpg.cpg import Cpg
from hexapod_cpg.mapping import ACTION_SIZE, command_from_action
from hexapod_cpg.oscillator import start_state
from hexapod_sim.task import LineTask, Outcome

from hexapod_agent.environment.env import Observation, read_observation
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_agent.specification.run_spec import RunSpec


class Robots:
    """Robots side by side, each with its task, giving the numbers that each gives alone.

    Attributes:
        actions: What each robot is told next (places, 30); zeros where nobody is.
    """

    def __init__(self, config: RunSpec, places: int) -> None:
        self._config = config.cpg
        # A model of its own for each: advancing switches the model's sensors off and on.
        self._tasks = [LineTask(config.task, config.sensors) for _ in range(places)]
        self._cpg = Cpg(config.cpg.hopf, (places,))
        self._targets = np.zeros(0)
        self.actions = np.zeros((places, ACTION_SIZE), np.float32)

    def reset(self, place: int, spec: ObservationSpec, seed: int) -> tuple[Observation, Outcome]:
        """Begin an episode at one place, and observe its start."""
        outcome = self._tasks[place].reset(seed)
        self._cpg.x[place], self._cpg.y[place] = start_state(self._cpg.config)
        self.actions[place] = 0.0
        return self.observe(place, spec), outcome

    def command(self) -> None:
        """Turn all actions into the joint targets of the next control period."""
        self._targets = self._cpg.advance(
            command_from_action(self.actions, self._config.reading, self._config.ranges)
        )

    def advance(self, place: int) -> Outcome:
        """Advance the physics of one robot by what was commanded; places may run in threads."""
        return self._tasks[place].advance(self._targets[place])

    def observe(self, place: int, spec: ObservationSpec) -> Observation:
        """Observe one robot, its action being the one that was commanded last.

        Raises:
            hexapod_agent.specification.observation.ObservationError: A reading is not finite.
        """
        x, y = self._cpg.x[place], self._cpg.y[place]
        return read_observation(self._tasks[place], x, y, spec, self.actions[place])
