# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The robots of a fleet: pattern generators in batches, physics for each robot apart."""

import numpy as np
from hexapod_cpg.cpg import Cpg
from hexapod_cpg.mapping import ACTION_SIZE, command_from_action
from hexapod_cpg.oscillator import start_state
from hexapod_sim.robot import JOINTS, SUBSTEPS
from hexapod_sim.task import LineTask, Outcome

from hexapod_agent.environment.env import Observation, read_observation
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.specification.sections import CpgConfig


class PatternError(RuntimeError):
    """A pattern generator cannot follow its commands; the text says which."""


class Robots:
    """Robots side by side, each with its run's task, giving the numbers that each gives alone.

    Those with equal pattern generators compute them as one batch.

    Attributes:
        actions: What each robot is told next (places, 30); zeros where nobody is.
    """

    def __init__(self, places: int) -> None:
        self._tasks: list[LineTask | None] = [None] * places
        self._configs: list[CpgConfig | None] = [None] * places
        self._cpgs: dict[CpgConfig, Cpg] = {}
        self._faults: dict[CpgConfig, str] = {}
        """Why there are no targets of the pattern generators in this period."""
        self._targets = np.zeros((places, SUBSTEPS, len(JOINTS)))
        self.actions = np.zeros((places, ACTION_SIZE), np.float32)

    def reset(self, place: int, config: RunSpec, seed: int) -> tuple[Observation, Outcome]:
        """Begin an episode of a run at one place, and observe its start."""
        self._configs[place] = config.cpg
        for unused in set(self._cpgs) - set(self._configs):
            del self._cpgs[unused]
        if config.cpg not in self._cpgs:
            self._cpgs[config.cpg] = Cpg(config.cpg.hopf, (len(self._tasks),))
        cpg = self._cpgs[config.cpg]
        cpg.x[place], cpg.y[place] = start_state(cpg.config)
        self.actions[place] = 0.0
        task = self._task(place, config)
        outcome = task.reset(seed)
        return self.observe(place, config.observed), outcome

    def _task(self, place: int, config: RunSpec) -> LineTask:
        """Return the task at a place, which is kept as long as its runs have the same."""
        task = self._tasks[place]
        if task is None or (task.config, task.sensors.qualities) != (config.task, config.sensors):
            # A model of its own for each: advancing switches the model's sensors off and on.
            task = self._tasks[place] = LineTask(config.task, config.sensors)
        return task

    def command(self) -> None:
        """Turn all actions into the joint targets of the next control period."""
        self._faults.clear()
        for config, cpg in self._cpgs.items():
            command = command_from_action(self.actions, config.reading, config.ranges)
            mine = [each == config for each in self._configs]
            try:
                self._targets[mine] = cpg.advance(command)[mine]
            except ValueError as error:
                self._faults[config] = str(error)

    def advance(self, place: int) -> Outcome:
        """Advance the physics of one robot by what was commanded; places may run in threads.

        Raises:
            PatternError: Nothing could be commanded.
        """
        config = self._configs[place]
        if config in self._faults:
            raise PatternError(self._faults[config])
        return self._robot(place)[0].advance(self._targets[place])

    def observe(self, place: int, spec: ObservationSpec) -> Observation:
        """Observe one robot, its action being the one that was commanded last.

        Raises:
            hexapod_agent.specification.observation.ObservationError: A reading is not finite.
        """
        task, cpg = self._robot(place)
        return read_observation(task, cpg.x[place], cpg.y[place], spec, self.actions[place])

    def _robot(self, place: int) -> tuple[LineTask, Cpg]:
        """Return task and pattern generator at a place where an episode has begun."""
        task, config = self._tasks[place], self._configs[place]
        assert task is not None
        assert config is not None
        return task, self._cpgs[config]
