# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Commands, joint states and joint trajectories as ROS messages."""

from array import array

import numpy as np
from hexapod_interfaces.msg import CpgCommand, CpgState
from hexapod_node.invalid_message import InvalidMessageError
from hexapod_node.stamps import duration_message, time_message
from hexapod_sim.joint_names import by_joint
from hexapod_sim.robot import (
    CONTROL_PERIOD_NS,
    JOINT_LOWER,
    JOINT_UPPER,
    JOINTS,
    PROPORTIONAL_BAND,
    SUBSTEPS,
)
from numpy.typing import NDArray
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from hexapod_cpg.cpg import Cpg
from hexapod_cpg.mapping import COMMAND_FIELDS, Command

_SUBSTEP_NS = CONTROL_PERIOD_NS // SUBSTEPS
# A load pushes a servo at a limit so far beyond it; what is farther out is no angle of this robot.
_BEYOND_LIMIT = PROPORTIONAL_BAND


def command_to_message(command: Command, message: CpgCommand) -> None:
    """Write a command of shape (6,) per field into a message."""
    for field in COMMAND_FIELDS:
        setattr(message, field, np.asarray(getattr(command, field), dtype=np.float64))


def command_from_message(message: CpgCommand) -> Command:
    """Return the command that a message carries.

    Raises:
        InvalidMessageError: a field holds a number that is not finite; the text names the field.
    """
    values = [np.asarray(getattr(message, field), dtype=np.float64) for field in COMMAND_FIELDS]
    if not np.isfinite(np.concatenate(values)).all():
        field, value = next(
            (field, value)
            for field, value in zip(COMMAND_FIELDS, values, strict=True)
            if not np.isfinite(value).all()
        )
        raise InvalidMessageError(
            'not_finite', f'cpg/command: {field} is {value.tolist()}, expected 6 finite numbers'
        )
    return Command(*values)


def pose_from_message(message: JointState) -> NDArray[np.float64]:
    """Return the joint angles (18,), rad, that a message carries; matched by joint name.

    Raises:
        ValueError: a joint is missing or named twice, or names and numbers are not as many.
        InvalidMessageError: an angle is not finite, or none that the joint can have; the text
            names the joint.
    """
    try:
        pose = by_joint(message.name, message.position, 'position')
    except ValueError as error:
        raise ValueError(f'joint_states: {error}') from error
    # A comparison with NaN is false.
    good = (pose >= JOINT_LOWER - _BEYOND_LIMIT) & (pose <= JOINT_UPPER + _BEYOND_LIMIT)
    if not good.all():
        joint = int(np.argmin(good))
        raise InvalidMessageError(
            'beyond_limit' if np.isfinite(pose[joint]) else 'not_finite',
            f'joint_states: {JOINTS[joint]} is at {pose[joint]:.3g} rad, expected '
            f'{JOINT_LOWER[joint]:g} to {JOINT_UPPER[joint]:g}',
        )
    return pose


class OutputMessages:
    """What the pattern generator publishes, written into messages that are made once."""

    def __init__(self) -> None:
        points = [
            JointTrajectoryPoint(time_from_start=duration_message(_SUBSTEP_NS * (substep + 1)))
            for substep in range(SUBSTEPS)
        ]
        self._trajectory = JointTrajectory(joint_names=list(JOINTS), points=points)
        self._state = CpgState()

    def trajectory(self, targets: NDArray[np.float64], stamp_ns: int) -> JointTrajectory:
        """Return joint targets (SUBSTEPS, 18), rad, of the control period from a stamp on."""
        for point, target in zip(self._trajectory.points, targets, strict=True):
            point.positions = array('d', target.tobytes())
        self._trajectory.header.stamp = time_message(stamp_ns)
        return self._trajectory

    def state(self, cpg: Cpg, stamp_ns: int) -> CpgState:
        """Return the oscillators' state at a stamp."""
        self._state.header.stamp = time_message(stamp_ns)
        self._state.x = cpg.x
        self._state.y = cpg.y
        return self._state
