# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Frames by the joints are those of the MuJoCo model."""

import mujoco
import numpy as np
import pytest
from hexapod_bringup.frames import Transform, device_frames, foot_frames, link_frames
from hexapod_sim.simulation import Simulation
from scipy.spatial.transform import Rotation

from hexapod_sim import robot


@pytest.fixture(scope='module')
def posed() -> tuple[mujoco.MjData, dict[str, float], Transform]:
    """The model in a random pose, its joint angles, and the pose of its body."""
    model = Simulation().model
    data = mujoco.MjData(model)
    generator = np.random.default_rng(3)
    angles = generator.uniform(robot.JOINT_LOWER, robot.JOINT_UPPER)
    turn = Rotation.from_euler('xyz', [0.2, -0.3, 1.1])
    x, y, z, w = turn.as_quat()
    data.qpos[:] = [0.4, -0.7, 0.2, w, x, y, z, *angles]
    mujoco.mj_forward(model, data)
    base = Transform(robot.ODOM_FRAME, robot.BASE_FRAME, data.qpos[:3].copy(), turn)
    return data, dict(zip(robot.JOINTS, angles.tolist(), strict=True)), base


def test_links_chain_to_the_poses_of_the_model(posed) -> None:
    data, angles, base = posed
    poses = {robot.BASE_FRAME: base}
    for link in link_frames(angles):
        poses[link.child] = poses[link.parent] @ link
    assert len(poses) == 19
    for name, pose in poses.items():
        np.testing.assert_allclose(pose.position, data.body(name).xpos, atol=1e-7)
        matrix = data.body(name).xmat.reshape(3, 3)
        np.testing.assert_allclose(pose.rotation.as_matrix(), matrix, atol=1e-7)


def test_feet_are_at_the_tips_with_the_axes_of_odom(posed) -> None:
    data, angles, base = posed
    feet = list(foot_frames(base, link_frames(angles)))
    assert tuple(foot.child for foot in feet) == robot.FOOT_FRAMES
    for foot in feet:
        assert foot.parent == robot.ODOM_FRAME
        np.testing.assert_allclose(foot.position, data.site(foot.child).xpos, atol=1e-7)
        assert foot.rotation.magnitude() == 0.0


def test_a_leg_with_an_absent_joint_has_no_foot(posed) -> None:
    _, angles, base = posed
    known = {name: angle for name, angle in angles.items() if name != 'rf_knee'}
    links = link_frames(known)
    assert 'rf_femur' not in {link.child for link in links}
    assert 'rf_foot' not in {foot.child for foot in foot_frames(base, links)}
    assert len(links) == 17


def test_the_range_finder_looks_down() -> None:
    frames = {frame.child: frame for frame in device_frames()}
    assert frames.keys() == {robot.IMU_FRAME, robot.HEIGHT_FRAME}
    looks = frames[robot.HEIGHT_FRAME].rotation.apply([1.0, 0.0, 0.0])
    np.testing.assert_allclose(looks, [0.0, 0.0, -1.0], atol=1e-12)
