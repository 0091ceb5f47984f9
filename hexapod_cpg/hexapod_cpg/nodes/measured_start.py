# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Where the robot is before its first motion in real time, as its joints tell."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from hexapod_node.newest import Input, NewestSamples
from hexapod_node.parameters import Parameter
from hexapod_sim.robot import NEUTRAL_POSE
from numpy.typing import NDArray
from sensor_msgs.msg import JointState

from hexapod_cpg.nodes.messages import pose_from_message

if TYPE_CHECKING:
    from rclpy.node import Node

MEASURED = 'measured'
STANDING = 'standing'
START_FROM = Parameter(
    'start_from',
    MEASURED,
    'realtime: where the first motion begins. measured: at the joints, after the first good '
    'joint_states; standing: at the standing pose, for a robot that stands and has no feedback',
    choices=(MEASURED, STANDING),
)

_TOPIC = 'joint_states'
_THROTTLE_S = 5.0


class MeasuredStart:
    """Waits for the joint angles that the robot starts from."""

    def __init__(self, node: Node, max_age_ns: int) -> None:
        """Begin to listen.

        Args:
            node: that subscribes.
            max_age_ns: greatest age of the angles when they are taken.
        """
        self._node = node
        wanted = Input(JointState, max_age_ns, pose_from_message)
        self._samples = NewestSamples(node, {_TOPIC: wanted})

    def destroy(self) -> None:
        """Listen no more."""
        self._samples.destroy()

    def take(self) -> NDArray[np.float64] | None:
        """Return the measured joint angles (18,) [rad]; None, and a line in the log, without."""
        newest = self._samples.take()
        if newest is None:
            self._node.get_logger().warning(self.fault(), throttle_duration_sec=_THROTTLE_S)
            return None
        pose: NDArray[np.float64] = newest[_TOPIC]
        farthest = np.abs(pose - NEUTRAL_POSE).max()
        self._node.get_logger().info(
            f'starts from the measured joints, up to {farthest:.2f} rad off the standing pose'
        )
        return pose

    def fault(self) -> str:
        """Say what it waits for."""
        return f'does not move, waits for {self._samples.fault() or _TOPIC}'

    def values(self) -> dict[str, object]:
        """Return what the diagnostics show of the samples."""
        return self._samples.values()
