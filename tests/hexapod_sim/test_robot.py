# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The compiled hexapod.xml holds the numbers of robot.py."""

import math

import mujoco
import numpy as np
import pytest
from hexapod_sim.scenes.table import SceneConfig
from hexapod_sim.simulation import Simulation

from hexapod_sim import robot


@pytest.fixture(scope='module')
def model() -> mujoco.MjModel:
    return Simulation().model


def test_joint_vector_is_leg_major_in_the_published_leg_order() -> None:
    assert robot.LEGS == ('lf', 'lm', 'lr', 'rf', 'rm', 'rr')
    assert robot.JOINTS[:4] == ('lf_hip', 'lf_knee', 'lf_ankle', 'lm_hip')
    assert len(robot.JOINTS) == 18


def test_joints_and_actuators_follow_the_joint_vector(model: mujoco.MjModel) -> None:
    joints = [model.joint(i).name for i in range(1, model.njnt)]
    actuators = [model.actuator(i).name for i in range(model.nu)]
    assert tuple(joints) == robot.JOINTS
    assert tuple(actuators) == robot.JOINTS
    assert [model.actuator(i).trnid[0] for i in range(model.nu)] == list(range(1, model.njnt))


def test_gravity_is_that_of_the_model(model: mujoco.MjModel) -> None:
    assert model.opt.gravity.tolist() == [0.0, 0.0, -robot.GRAVITY]


def test_timing_divides_the_control_period(model: mujoco.MjModel) -> None:
    assert model.opt.timestep == robot.PHYSICS_STEP_NS * 1e-9
    assert robot.TARGET_PERIOD_NS * robot.SUBSTEPS == robot.CONTROL_PERIOD_NS
    assert robot.TARGET_PERIOD_NS % robot.PHYSICS_STEP_NS == 0


def test_masses(model: mujoco.MjModel) -> None:
    assert model.body('base_link').mass[0] == pytest.approx(robot.BODY_MASS)
    for leg in robot.LEGS:
        assert model.body(f'{leg}_coxa').mass[0] == pytest.approx(robot.COXA_MASS)
        assert model.body(f'{leg}_femur').mass[0] == pytest.approx(robot.FEMUR_MASS)
        assert model.body(f'{leg}_tibia').mass[0] == pytest.approx(
            robot.TIBIA_MASS + robot.FOOT_MASS
        )
    assert model.body_mass.sum() == pytest.approx(robot.TOTAL_MASS)
    # DESIGN: a PhantomX-class robot of about 2.4 kg.
    assert pytest.approx(2.4) == robot.TOTAL_MASS


def test_link_lengths_and_hip_mounts(model: mujoco.MjModel) -> None:
    for i, leg in enumerate(robot.LEGS):
        hip = model.body(f'{leg}_coxa')
        np.testing.assert_allclose(hip.pos, robot.HIP_POSITIONS[i])
        yaw = robot.HIP_YAWS[i]
        np.testing.assert_allclose(
            hip.quat, [math.cos(yaw / 2), 0, 0, math.sin(yaw / 2)], atol=1e-8
        )
        np.testing.assert_allclose(model.body(f'{leg}_femur').pos, [robot.COXA_LENGTH, 0, 0])
        np.testing.assert_allclose(model.body(f'{leg}_tibia').pos, [robot.FEMUR_LENGTH, 0, 0])
        np.testing.assert_allclose(model.site(f'{leg}_foot').pos, [0, 0, -robot.TIBIA_LENGTH])
        np.testing.assert_allclose(model.geom(f'{leg}_foot').pos, [0, 0, -robot.TIBIA_LENGTH])
        assert model.geom(f'{leg}_foot').size[0] == robot.FOOT_RADIUS
        assert model.geom(f'{leg}_coxa').size[0] == robot.COXA_RADIUS
        assert model.geom(f'{leg}_femur').size[0] == robot.FEMUR_RADIUS
        assert model.geom(f'{leg}_tibia').size[0] == robot.TIBIA_RADIUS
    np.testing.assert_allclose(model.geom('body').size, robot.BODY_HALF_SIZE)


def test_left_and_right_are_mirror_images() -> None:
    mirrored = robot.HIP_POSITIONS[3:] * [1, -1, 1]
    np.testing.assert_array_equal(robot.HIP_POSITIONS[:3], mirrored)
    np.testing.assert_allclose(robot.HIP_YAWS[:3], -robot.HIP_YAWS[3:])


def test_servos(model: mujoco.MjModel) -> None:
    for i, name in enumerate(robot.JOINTS):
        servo, joint = model.actuator(name), model.joint(name)
        assert servo.gainprm[0] == pytest.approx(robot.SERVO_KP, rel=1e-7)
        np.testing.assert_allclose(servo.biasprm[:3], [0, -robot.SERVO_KP, 0], rtol=1e-7)
        np.testing.assert_array_equal(servo.forcerange, [-robot.TORQUE_LIMIT, robot.TORQUE_LIMIT])
        limits = [robot.JOINT_LOWER[i], robot.JOINT_UPPER[i]]
        np.testing.assert_array_equal(servo.ctrlrange, limits)
        np.testing.assert_array_equal(joint.range, limits)
        assert joint.damping[0] == pytest.approx(robot.SERVO_DAMPING, rel=1e-7)
        assert joint.armature[0] == robot.SERVO_ARMATURE
    assert robot.TORQUE_LIMIT == 1.5


def test_every_contact_has_the_floor_friction(model: mujoco.MjModel) -> None:
    solid = [i for i in range(model.ngeom) if model.geom_contype[i] or model.geom_conaffinity[i]]
    assert {model.geom(i).name for i in solid} == {
        'floor',
        'body',
        *(f'{leg}_foot' for leg in robot.LEGS),
    }
    friction = SceneConfig.of_article().friction
    np.testing.assert_array_equal(model.geom_friction[solid, 0], friction)


def test_keyframe_is_the_neutral_pose_at_the_standing_height(model: mujoco.MjModel) -> None:
    key = model.key('standing')
    np.testing.assert_allclose(key.qpos[:7], [0, 0, robot.STANDING_HEIGHT, 1, 0, 0, 0], atol=1e-7)
    np.testing.assert_array_equal(key.qpos[7:], robot.NEUTRAL_POSE)
    np.testing.assert_array_equal(key.ctrl, robot.NEUTRAL_POSE)
    np.testing.assert_array_equal(key.qvel, 0)


def test_frames_are_sites_of_the_model(model: mujoco.MjModel) -> None:
    sites = {model.site(i).name for i in range(model.nsite)}
    frames = {robot.BASE_FRAME, robot.IMU_FRAME, robot.HEIGHT_FRAME, *robot.FOOT_FRAMES}
    assert frames <= sites


def test_neutral_pose_and_forward_sign_stay_inside_the_limits() -> None:
    assert np.all(robot.JOINT_LOWER < robot.NEUTRAL_POSE)
    assert np.all(robot.NEUTRAL_POSE < robot.JOINT_UPPER)
    np.testing.assert_array_equal(robot.HIP_FORWARD_SIGN, [-1, -1, -1, 1, 1, 1])
