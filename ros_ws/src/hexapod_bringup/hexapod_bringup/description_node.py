# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `description`: the robot's URDF, latched, and its frames where tf2_msgs is installed."""

from collections.abc import Iterable, Sequence

import numpy as np
from ament_index_python import get_package_share_path
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import TransformStamped
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.node import Node
from hexapod_node.parameters import ConfigParameters
from hexapod_node.qos import DRIVER, LATCHED
from hexapod_node.spin import run
from hexapod_sim.robot import BASE_FRAME, ODOM_FRAME
from hexapod_sim.variations.table import RobotConfig
from nav_msgs.msg import Odometry
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from hexapod_bringup.description import description_of
from hexapod_bringup.frames import Transform, device_frames, foot_frames, link_frames

try:
    from tf2_msgs.msg import TFMessage
except ImportError:
    TFMessage = None


class DescriptionNode(Node):
    """Shows what the robot is, and where its parts are as `joint_states` and `odom` say.

    Its parameters `robot.…` are those of the node `sim`; the description follows them.
    """

    def __init__(self) -> None:
        super().__init__('description')
        shipped = get_package_share_path('hexapod_bringup') / 'urdf' / 'hexapod.urdf'
        self._shipped = shipped.read_text(encoding='utf-8')
        self._robot = ConfigParameters(self, RobotConfig.of_article(), 'robot')
        self._description = self.create_publisher(String, 'robot_description', LATCHED)
        self._describe()
        self.add_post_set_parameters_callback(lambda _: self._describe())
        self._links: list[Transform] = []
        self._sent = 0
        if TFMessage is None:
            self.get_logger().warning('tf2_msgs is not installed: no frames on tf')
        else:
            self._start_frames()
        Diagnostics(self, self._health)

    def _describe(self) -> None:
        self._description.publish(String(data=description_of(self._shipped, self._robot.get())))

    def _start_frames(self) -> None:
        """Publish the frames that stay, and those that move whenever a sensor tells."""
        # Relative, as the sim's clock is: workers side by side do not clash.
        self._static = self.create_publisher(TFMessage, 'tf_static', LATCHED)
        self._moving = self.create_publisher(TFMessage, 'tf', 100)
        now = self.get_clock().now().to_msg()
        self._static.publish(tf_message(device_frames(), now))
        self.create_subscription(JointState, 'joint_states', self._on_joints, DRIVER)
        self.create_subscription(Odometry, 'odom', self._on_odometry, DRIVER)

    def _on_joints(self, message: JointState) -> None:
        if self._moving.get_subscription_count():
            self._links = link_frames(dict(zip(message.name, message.position, strict=False)))
            self._send(self._links, message.header.stamp)

    def _on_odometry(self, message: Odometry) -> None:
        if self._moving.get_subscription_count():
            base = base_frame(message)
            self._send([base, *foot_frames(base, self._links)], message.header.stamp)

    def _send(self, transforms: Iterable[Transform], stamp: Time) -> None:
        self._moving.publish(tf_message(transforms, stamp))
        self._sent += 1

    def _health(self) -> Health:
        text = 'describing' if TFMessage else 'describing; no frames without tf2_msgs'
        return DiagnosticStatus.OK, text, {'tf_messages': self._sent}


def base_frame(message: Odometry) -> Transform:
    """Return the pose of base_link in odom."""
    position, q = message.pose.pose.position, message.pose.pose.orientation
    rotation = Rotation.from_quat([q.x, q.y, q.z, q.w])
    return Transform(
        ODOM_FRAME, BASE_FRAME, np.array([position.x, position.y, position.z]), rotation
    )


def tf_message(transforms: Iterable[Transform], stamp: Time) -> TFMessage:
    """Return transforms of one instant as tf2 has them."""
    return TFMessage(transforms=[_stamped(transform, stamp) for transform in transforms])


def _stamped(transform: Transform, stamp: Time) -> TransformStamped:
    message = TransformStamped(child_frame_id=transform.child)
    message.header.frame_id = transform.parent
    message.header.stamp = stamp
    pose = message.transform
    v, q = pose.translation, pose.rotation
    v.x, v.y, v.z = transform.position.tolist()
    q.x, q.y, q.z, q.w = transform.rotation.as_quat().tolist()
    return message


def main(args: Sequence[str] | None = None) -> None:
    """Run the node until a signal comes."""
    run(DescriptionNode, args)
