# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Joints that are stuck."""

from dataclasses import dataclass
from typing import Annotated

import mujoco
from annotated_types import Interval
from pydantic import AfterValidator

from hexapod_sim.robot import JOINT_LOWER, JOINT_UPPER, JOINTS
from hexapod_sim.variations.variation import Variation, named

# Time constant [s] and damping ratio with which a joint comes to its angle, and shares of the
# force that holds it there: the whole torque of a servo moves it by 1e-3 rad.
_SOLREF = (0.02, 1.0)
_SOLIMP = (0.99, 0.999, 0.001, 0.5, 2.0)


def _check_joints(text: str) -> str:
    named(text, JOINTS)
    return text


@dataclass(frozen=True)
class BlockedJointOptions:
    """Options of blocked joints."""

    blocked_joints: Annotated[str, AfterValidator(_check_joints)]
    """Blocked joints: which, with + between them, or none."""
    blocked_angle: Annotated[float, Interval(ge=-1.2, le=1.2)]
    """Blocked joints: where; with a fault_time they are there within 0.1 s [rad]."""


class BlockedJoints(Variation):
    """Joints held at an angle; their servos push against it, as their torques show."""

    def __init__(self, options: BlockedJointOptions) -> None:
        """Take joints and angle."""
        self._joints, self._angle = named(options.blocked_joints, JOINTS), options.blocked_angle

    @property
    def is_present(self) -> bool:
        """Whether there is one."""
        return bool(self._joints)

    def prepare(self, spec: mujoco.MjSpec) -> None:
        """Add constraints that do not act."""
        for joint in self._joints:
            hold = spec.add_equality(
                name=joint,
                type=mujoco.mjtEq.mjEQ_JOINT,
                objtype=mujoco.mjtObj.mjOBJ_JOINT,
                name1=joint,
                active=False,
                solref=_SOLREF,
                solimp=_SOLIMP,
            )
            hold.data[:5] = self._angle, 0.0, 0.0, 0.0, 0.0

    def apply(self, spec: mujoco.MjSpec) -> None:
        """Let them act."""
        for joint in self._joints:
            spec.equality(joint).active = True


def check_angle(options: BlockedJointOptions) -> None:
    """Refuse an angle that a joint does not reach.

    Raises:
        ValueError: The text names the joint.
    """
    for joint in named(options.blocked_joints, JOINTS):
        place = JOINTS.index(joint)
        if not JOINT_LOWER[place] <= options.blocked_angle <= JOINT_UPPER[place]:
            raise ValueError(
                f'robot.blocked_angle is {options.blocked_angle}, expected {JOINT_LOWER[place]} '
                f'to {JOINT_UPPER[place]} for {joint}'
            )
