# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A late listener gets the URDF; frames come where tf2_msgs is, and their absence is one line."""

import importlib.util

import pytest
from hexapod_bringup.description_node import DescriptionNode, base_frame
from hexapod_node.qos import LATCHED
from hexapod_sim.robot import JOINTS
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Log
from rclpy.parameter import Parameter
from robot_urdf import robot_description
from sensor_msgs.msg import JointState
from std_msgs.msg import String

pytestmark = pytest.mark.graph
WITH_TF = importlib.util.find_spec('tf2_msgs') is not None


def test_a_late_listener_gets_the_description(graph) -> None:
    graph.add(DescriptionNode())
    heard: list[String] = []
    graph.nodes[0].create_subscription(String, 'robot_description', heard.append, LATCHED)
    graph.until(lambda: heard)
    assert heard[0].data == robot_description()


def test_the_description_follows_its_parameters(graph) -> None:
    node = graph.add(DescriptionNode())
    heard: list[String] = []
    graph.nodes[0].create_subscription(String, 'robot_description', heard.append, LATCHED)
    (result,) = node.set_parameters([Parameter('robot.payload', value=1.2)])
    assert result.successful
    graph.until(lambda: heard and 'payload' in heard[-1].data)
    (result,) = node.set_parameters([Parameter('robot.dead_legs', value='tail')])
    assert not result.successful
    assert 'robot.dead_legs: expected' in result.reason


def test_base_frame_is_the_pose_of_odometry() -> None:
    message = Odometry()
    position, q = message.pose.pose.position, message.pose.pose.orientation
    position.x, position.y, position.z = 1.0, 2.0, 3.0
    q.x, q.y, q.z, q.w = 0.6, 0.0, 0.0, 0.8
    frame = base_frame(message)
    assert (frame.parent, frame.child) == ('odom', 'base_link')
    assert frame.position.tolist() == [1.0, 2.0, 3.0]
    assert frame.rotation.as_quat().tolist() == pytest.approx([0.6, 0.0, 0.0, 0.8])


@pytest.mark.skipif(WITH_TF, reason='tf2_msgs is installed')
def test_without_tf2_msgs_one_line_says_so(graph) -> None:
    lines: list[Log] = []
    graph.nodes[0].create_subscription(Log, '/rosout', lines.append, LATCHED)
    node = graph.add(DescriptionNode())
    graph.until(lambda: any(line.name == 'description' for line in lines))
    (line,) = [line.msg for line in lines if line.name == 'description']
    assert line == 'tf2_msgs is not installed: no frames on tf'
    assert '/tf' not in dict(node.get_topic_names_and_types())


@pytest.mark.skipif(not WITH_TF, reason='tf2_msgs is not installed')
def test_frames_follow_joints_and_odometry(graph) -> None:
    from tf2_msgs.msg import TFMessage

    moving: list[TFMessage] = []
    still: list[TFMessage] = []
    helper = graph.nodes[0]
    helper.create_subscription(TFMessage, 'tf', moving.append, 100)
    helper.create_subscription(TFMessage, 'tf_static', still.append, LATCHED)
    joints = helper.create_publisher(JointState, 'joint_states', 10)
    odometry = helper.create_publisher(Odometry, 'odom', 10)
    node = graph.add(DescriptionNode())
    publishers = (joints, odometry, node._moving)
    graph.until(lambda: all(publisher.get_subscription_count() for publisher in publishers))
    message = JointState(name=list(JOINTS), position=[0.1] * 18)
    message.header.stamp.sec = 7
    joints.publish(message)
    graph.until(lambda: moving)
    where = Odometry()
    where.header.stamp.sec = 7
    where.pose.pose.orientation.w = 1.0
    odometry.publish(where)
    graph.until(lambda: len(moving) == 2 and still)
    assert len(moving[0].transforms) == 18
    assert [t.child_frame_id for t in moving[1].transforms][:2] == ['base_link', 'lf_foot']
    assert all(t.header.stamp.sec == 7 for tf in moving for t in tf.transforms)
    assert {t.child_frame_id for t in still[0].transforms} == {'imu_link', 'height_link'}
