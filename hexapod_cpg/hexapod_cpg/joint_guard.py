# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Keeps joint targets within the robot's limits and rates, whatever they were made from."""

import numpy as np
from numpy.typing import NDArray

from hexapod_sim import robot

_TARGET_PERIOD_S = robot.TARGET_PERIOD_NS * 1e-9


class JointGuard:
    """The last word on every joint target.

    Attributes:
        position: Last target that left here (18,) [rad].
        beyond_limit: Control periods in which a target lay beyond a joint limit.
        beyond_rate: Control periods in which a target asked for more than the greatest rate.
    """

    def __init__(self, max_rate: float) -> None:
        """Begin at the standing pose.

        Args:
            max_rate: Greatest rate of a joint target [rad/s].
        """
        self.position: NDArray[np.float64] = robot.NEUTRAL_POSE.copy()
        self.beyond_limit = 0
        self.beyond_rate = 0
        self._max_step = max_rate * _TARGET_PERIOD_S

    def reset(self, pose: NDArray[np.float64] = robot.NEUTRAL_POSE) -> None:
        """Take the robot to be in a pose (18,) [rad], or as near to it as the limits allow."""
        self.position = np.clip(pose, robot.JOINT_LOWER, robot.JOINT_UPPER)

    def limit(self, targets: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return targets (SUBSTEPS, 18) within the joint limits; the good ones stay as they are.

        The rate is watched, not changed.
        """
        limited = targets.clip(robot.JOINT_LOWER, robot.JOINT_UPPER)
        self.beyond_limit += bool((limited != targets).any())
        path = np.concatenate((self.position[None], limited))
        steps = path[1:] - path[:-1]
        self.beyond_rate += bool(np.abs(steps).max() > self._max_step)
        self.position = limited[-1].copy()
        return limited

    def follow(self, targets: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return targets (SUBSTEPS, 18) within joint limits and rates, as near as they allow."""
        start = self.position
        limited = self.limit(targets)
        return self._paced(start, limited, self._max_step)

    def approach(self, goal: NDArray[np.float64], rate: float) -> NDArray[np.float64]:
        """Return the targets (SUBSTEPS, 18) of a way to a pose (18,) at no more than a rate."""
        goals = np.broadcast_to(goal, (robot.SUBSTEPS, *goal.shape))
        return self._paced(self.position, goals, rate * _TARGET_PERIOD_S)

    def _paced(
        self, start: NDArray[np.float64], targets: NDArray[np.float64], max_step: float
    ) -> NDArray[np.float64]:
        """Clip each target to what a step from the one before can reach."""
        paced = np.empty_like(targets)
        position = start
        for index, target in enumerate(targets):
            position = np.clip(target, position - max_step, position + max_step)
            paced[index] = position
        self.position = position
        return paced
