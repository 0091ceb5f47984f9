# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Where the robot's frames are: links by the joints, and feet as their force sensors name them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from hexapod_sim import robot

Vector = NDArray[np.float64]

_STILL = Rotation.identity()
_DOWN = Rotation.from_euler('y', np.pi / 2)  # x axis of a range finder under the body


@dataclass(frozen=True)
class Transform:
    """Pose of a frame in its parent.

    Attributes:
        parent: frame.
        child: frame.
        position: of the child's origin in the parent (3,) [m].
        rotation: of the child's axes in the parent.
    """

    parent: str
    child: str
    position: Vector
    rotation: Rotation

    def __matmul__(self, other: Transform) -> Transform:
        """Chain with a transform whose parent is this one's child."""
        position = self.position + self.rotation.apply(other.position)
        return Transform(self.parent, other.child, position, self.rotation * other.rotation)


def device_frames() -> list[Transform]:
    """Return the frames that stay where they are in base_link."""
    return [
        Transform(robot.BASE_FRAME, robot.IMU_FRAME, np.zeros(3), _STILL),
        Transform(robot.BASE_FRAME, robot.HEIGHT_FRAME, np.zeros(3), _DOWN),
    ]


def link_frames(angles: Mapping[str, float]) -> list[Transform]:
    """Return the pose of each link in the one before it.

    Args:
        angles: of the joints by their names [rad]; links of absent joints are left out.
    """
    return [
        transform
        for index, leg in enumerate(robot.LEGS)
        for joint, transform in _leg(index, leg, angles)
        if joint in angles
    ]


def foot_frames(base: Transform, links: list[Transform]) -> Iterator[Transform]:
    """Yield the pose in odom of each foot whose leg is complete: its axes are those of odom.

    Args:
        base: pose of base_link in odom.
        links: of `link_frames`.
    """
    by_child = {link.child: link for link in links}
    for leg, frame in zip(robot.LEGS, robot.FOOT_FRAMES, strict=True):
        chain = [by_child.get(f'{leg}_{part}') for part in ('coxa', 'femur', 'tibia')]
        pose = base
        for link in chain:
            if link is None:
                break
            pose = pose @ link
        else:
            tip = pose.rotation.apply([0.0, 0.0, -robot.TIBIA_LENGTH])
            yield Transform(base.parent, frame, pose.position + tip, _STILL)


def _leg(index: int, leg: str, angles: Mapping[str, float]) -> Iterator[tuple[str, Transform]]:
    """Yield joint and transform from the body to the tibia."""
    hip, knee, ankle = (angles.get(f'{leg}_{joint}', 0.0) for joint in robot.LEG_JOINTS)
    turns = (
        Rotation.from_euler('z', robot.HIP_YAWS[index] + hip),
        Rotation.from_euler('y', -knee),
        Rotation.from_euler('y', -ankle),
    )
    positions = (
        robot.HIP_POSITIONS[index],
        np.array([robot.COXA_LENGTH, 0.0, 0.0]),
        np.array([robot.FEMUR_LENGTH, 0.0, 0.0]),
    )
    parent = robot.BASE_FRAME
    for joint, part, position, turn in zip(
        robot.LEG_JOINTS, ('coxa', 'femur', 'tibia'), positions, turns, strict=True
    ):
        child = f'{leg}_{part}'
        yield f'{leg}_{joint}', Transform(parent, child, position, turn)
        parent = child
