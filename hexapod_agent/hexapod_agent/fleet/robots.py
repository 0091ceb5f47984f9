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
        actions: What each robot is told next (slots, 30); zeros where nobody is.
    """

    def __init__(self, slots: int) -> None:
        self._tasks: list[LineTask | None] = [None] * slots
        self._configs: list[CpgConfig | None] = [None] * slots
        self._cpgs: dict[CpgConfig, Cpg] = {}
        self._faults: dict[CpgConfig, str] = {}
        """Why there are no targets of the pattern generators in this period."""
        self._targets = np.zeros((slots, SUBSTEPS, len(JOINTS)))
        self.actions = np.zeros((slots, ACTION_SIZE), np.float32)

    def reset(self, slot: int, config: RunSpec, seed: int) -> tuple[Observation, Outcome]:
        """Begin an episode of a run at one slot, and observe its start."""
        self._configs[slot] = config.cpg
        for unused in set(self._cpgs) - set(self._configs):
            del self._cpgs[unused]
        if config.cpg not in self._cpgs:
            self._cpgs[config.cpg] = Cpg(config.cpg.hopf, (len(self._tasks),))
        cpg = self._cpgs[config.cpg]
        cpg.x[slot], cpg.y[slot] = start_state(cpg.config)
        self.actions[slot] = 0.0
        task = self._task(slot, config)
        outcome = task.reset(seed)
        return self.observe(slot, config.observed), outcome

    def _task(self, slot: int, config: RunSpec) -> LineTask:
        """Return the task at a slot, which is kept as long as its runs have the same."""
        task = self._tasks[slot]
        if task is None:
            # A model of its own for each: advancing switches the model's sensors off and on.
            task = self._tasks[slot] = LineTask(config.task, config.sensors, config.world)
        task.enter(config.world)
        task.config, task.sensors.qualities = config.task, config.sensors
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

    def advance(self, slot: int) -> Outcome:
        """Advance the physics of one robot by what was commanded; slots may run in threads.

        Raises:
            PatternError: Nothing could be commanded.
        """
        config = self._configs[slot]
        if config in self._faults:
            raise PatternError(self._faults[config])
        return self._robot(slot)[0].advance(self._targets[slot])

    def observe(self, slot: int, spec: ObservationSpec) -> Observation:
        """Observe one robot, its action being the one that was commanded last.

        Raises:
            hexapod_agent.specification.observation.ObservationError: A reading is not finite.
        """
        task, cpg = self._robot(slot)
        return read_observation(task, cpg.x[slot], cpg.y[slot], spec, self.actions[slot])

    def _robot(self, slot: int) -> tuple[LineTask, Cpg]:
        """Return task and pattern generator at a slot where an episode has begun."""
        task, config = self._tasks[slot], self._configs[slot]
        assert task is not None
        assert config is not None
        return task, self._cpgs[config]
