# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A node of one's own beside a bag, a worker or a robot: which feet carry the robot.

ros2 run hexapod_doe player_node --ros-args -p bag:=bags/sample      # in another shell
python examples/listen.py --ros-args -r __ns:=/hexapod
"""

import rclpy
from geometry_msgs.msg import WrenchStamped
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data

LEGS = ('lf', 'lm', 'lr', 'rf', 'rm', 'rr')


class FootLoads(Node):
    """Averages the vertical force on each foot, and prints it every simulated second.

    Attributes:
        loads: Mean vertical force by leg, of the last second [N].
    """

    def __init__(self, context: Context | None = None) -> None:
        super().__init__('foot_loads', context=context)
        self.loads: dict[str, float] = {}
        self._forces: dict[str, list[float]] = {leg: [] for leg in LEGS}
        for leg in LEGS:
            # Best effort hears reliable publishers and drivers that are not.
            self.create_subscription(
                WrenchStamped,
                f'foot_force/{leg}',
                lambda message, leg=leg: self.hear(leg, message),
                qos_profile_sensor_data,
            )

    def hear(self, leg: str, message: WrenchStamped) -> None:
        """Take in one sample of a foot."""
        forces = self._forces[leg]
        forces.append(message.wrench.force.z)
        if leg == LEGS[-1] and len(forces) == 40:  # control periods of 25 ms
            self.loads = {leg: sum(each) / max(len(each), 1) for leg, each in self._forces.items()}
            self._forces = {leg: [] for leg in LEGS}
            told = ', '.join(f'{leg} {load:.1f} N' for leg, load in self.loads.items())
            self.get_logger().info(told)


def main() -> None:
    """Listen until Ctrl-C."""
    rclpy.init()
    try:
        rclpy.spin(FootLoads())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
