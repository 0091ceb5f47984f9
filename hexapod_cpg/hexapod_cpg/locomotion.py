# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Walks as commanded, begins and stops safely: slowly to the standing pose."""

from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from hexapod_cpg.cpg import Cpg
from hexapod_cpg.joint_guard import JointGuard
from hexapod_cpg.mapping import Command
from hexapod_cpg.oscillator import HopfConfig
from hexapod_sim import robot


class Motion(StrEnum):
    """What the legs do."""

    WAITING = 'waiting'
    """Nothing, for nobody knows where the joints are."""
    RISING = 'rising'
    """They go to the standing pose for the first time; commands are for later."""
    STANDING = 'standing'
    WALKING = 'walking'
    STOPPING = 'stopping'


class Locomotion:
    """A pattern generator behind a joint guard.

    Attributes:
        cpg: The pattern generator.
        guard: What its targets pass through.
        motion: What the last control period did.
    """

    def __init__(self, config: HopfConfig, guard: JointGuard, stop_rate: float) -> None:
        """Begin standing.

        Args:
            config: Of the oscillators.
            guard: Of the joints.
            stop_rate: Rate of every joint on its way to the standing pose [rad/s].
        """
        self.cpg = Cpg(config)
        self.guard = guard
        self.motion = Motion.STANDING
        self._stop_rate = stop_rate

    def restart(self, config: HopfConfig) -> None:
        """Put the oscillators at the start of the gait."""
        self.cpg = Cpg(config)

    def stand(self, config: HopfConfig) -> None:
        """Begin an episode: the robot was put in its standing pose."""
        self.restart(config)
        self.guard.reset()
        self.motion = Motion.STANDING

    def hold(self, config: HopfConfig) -> None:
        """Begin where the last target left the robot, with the way to the standing pose."""
        self.restart(config)
        self.motion = Motion.STANDING if self._stands else Motion.STOPPING

    def wait(self, config: HopfConfig) -> None:
        """Begin without knowing where the joints are: `rise` is to tell."""
        self.restart(config)
        self.motion = Motion.WAITING

    def rise(self, pose: NDArray[np.float64]) -> None:
        """Begin in a pose (18,) [rad] with the way to the standing pose."""
        self.guard.reset(pose)
        self.motion = Motion.RISING

    def play(self, command: Command) -> NDArray[np.float64]:
        """Advance one control period, within the joint limits; targets (SUBSTEPS, 18) [rad].

        Raises:
            ValueError: The command is of no use; nothing has changed.
        """
        targets = self.guard.limit(self._advance(command))
        self.motion = Motion.WALKING
        return targets

    def walk(self, command: Command) -> NDArray[np.float64]:
        """Advance one control period, within joint limits and rates; first of all rise.

        Raises:
            ValueError: The command is of no use; nothing has changed.
            RuntimeError: Nobody has told where the joints are.
        """
        if self.motion in (Motion.WAITING, Motion.RISING):
            return self.stop()
        targets = self.guard.follow(self._advance(command))
        self.motion = Motion.WALKING
        return targets

    def stop(self) -> NDArray[np.float64]:
        """Go on with the way to the standing pose for one control period, or stand there.

        Raises:
            RuntimeError: Nobody has told where the joints are.
        """
        if self.motion is Motion.WAITING:
            raise RuntimeError(
                'locomotion: expected rise(), hold() or stand() before the first motion'
            )
        on_the_way = Motion.RISING if self.motion is Motion.RISING else Motion.STOPPING
        targets = self.guard.approach(robot.NEUTRAL_POSE, self._stop_rate)
        self.motion = Motion.STANDING if self._stands else on_the_way
        return targets

    @property
    def _stands(self) -> bool:
        return np.array_equal(self.guard.position, robot.NEUTRAL_POSE)

    def _advance(self, command: Command) -> NDArray[np.float64]:
        # What overflows is not finite in the end, and refused.
        with np.errstate(over='ignore', invalid='ignore'):
            return self.cpg.advance(command)
