# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Pictures of the watch page show the robot that was heard, on the ground that the sim has."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest
from hexapod_bringup.watching.board import Pose, Robot
from hexapod_bringup.watching.signals import JOINT_STATES, LINE_OFFSET
from hexapod_bringup.watching.studio import HEIGHT, WIDTH, Scene, Stage
from hexapod_sim.robot import NEUTRAL_POSE
from hexapod_sim.world import World
from PIL import Image

UPRIGHT = (0.0, 0.0, 0.0, 1.0)


def heard() -> Robot:
    robot = Robot('w1', pose=Pose((1.0, 0.2, 0.13), UPRIGHT))
    robot.track(JOINT_STATES).add(0.0, NEUTRAL_POSE.tolist())
    robot.track(LINE_OFFSET).add(0.0, [0.2])
    return robot


@pytest.fixture(scope='module')
def stage():
    made = Stage(World.of_article())
    yield made
    made.close()


def pixels(picture: bytes) -> np.ndarray:
    image = Image.open(io.BytesIO(picture))
    assert image.size == (WIDTH, HEIGHT)
    return np.asarray(image, dtype=float)


def test_a_picture_follows_joints_and_pose(stage) -> None:
    robot = heard()
    standing = pixels(stage.shoot(Scene.of(robot)))
    assert np.abs(standing - pixels(stage.shoot(Scene.of(robot)))).max() == 0
    robot.track(JOINT_STATES).add(0.1, (NEUTRAL_POSE + 0.4).tolist())
    bent = pixels(stage.shoot(Scene.of(robot)))
    assert np.abs(bent - standing).mean() > 0.5
    robot.pose = Pose((1.0, 0.2, 0.13), (0.0, 0.0, 0.5, 0.866))
    assert np.abs(pixels(stage.shoot(Scene.of(robot))) - bent).mean() > 0.5


def test_a_real_robot_without_a_pose_stands_on_its_feet(stage) -> None:
    robot = heard()
    truth = pixels(stage.shoot(Scene.of(robot)))
    robot.pose = None
    assert pixels(stage.shoot(Scene.of(robot))).std() > 10
    assert truth.std() > 10


def test_nothing_is_drawn_before_the_joints_are_known() -> None:
    assert Scene.of(Robot('w1')) is None


def test_a_fault_is_seen_from_its_time_on() -> None:
    robot = heard()
    world = World.of_article()
    robot.world = replace(world, robot=replace(world.robot, dead_legs='lf', fault_time=4.0))
    robot.outcome = {'step': 159}
    assert Scene.of(robot).world.robot.dead_legs == 'none'
    robot.outcome = {'step': 160}
    assert Scene.of(robot).world.robot == replace(world.robot, dead_legs='lf')
