# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A node with one of everything, for the system tests of the command line to look at."""

import sys

import rclpy
from hexapod_interfaces.action import TrainRun
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.action import ActionServer
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import SetBool


class Sample(LifecycleNode):
    """Publishes 'chatter' and 'joint_states', takes 'listen', serves 'set_flag' and 'train'."""

    def __init__(self):
        super().__init__('sample')
        self.declare_parameter(
            'rate',
            2.5,
            ParameterDescriptor(
                description='Pace of nothing [Hz]',
                floating_point_range=[FloatingPointRange(from_value=0.5, to_value=9.0)],
            ),
        )
        self.declare_parameter('label', 'plain')
        self.declare_parameter('count', 7)
        self.declare_parameter('weights', [0.5, 1.5])
        self.declare_parameter('leg.phase', 0.25)
        self.declare_parameter('fixed', True, ParameterDescriptor(read_only=True))
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.chatter = self.create_publisher(String, 'chatter', 10)
        self.joints = self.create_publisher(JointState, 'joint_states', 10)
        self.status = self.create_publisher(String, 'status', latched)
        self.status.publish(String(data='ready'))
        self.create_subscription(String, 'listen', self.hear, 10)
        self.create_service(SetBool, 'set_flag', self.set_flag)
        self.action = ActionServer(
            self,
            TrainRun,
            'train',
            lambda handle: TrainRun.Result(),
        )
        self.ticks = 0
        self.create_timer(0.05, self.tick)

    def tick(self):
        if self.ticks == 0:
            print('sample is up', *sys.argv[1:2], flush=True)
        self.chatter.publish(String(data=f'tick {self.ticks}'))
        joints = JointState(name=['hip', 'knee'], position=[0.5, -1.0])
        joints.header.frame_id = 'base_link'
        self.joints.publish(joints)
        self.ticks += 1

    def hear(self, message):
        print(f'heard {message.data}', flush=True)

    def set_flag(self, request, response):
        response.success = request.data
        response.message = f'flag {request.data}'
        return response

    def on_configure(self, state):
        return TransitionCallbackReturn.SUCCESS


def main():
    """Run the node, which prints its first argument once it spins."""
    rclpy.init()
    node = Sample()
    executor = MultiThreadedExecutor(3)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except rclpy_implementation.RCLError:
        # A callback that is under way in another thread when the signal comes.
        if rclpy.ok():
            raise
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
