# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Sensor channels: sizes, units, frames and signs, against mechanics and MuJoCo's own state."""

import copy
import pickle
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from hexapod_sim.quality import PERFECT, Quality
from hexapod_sim.sensor_table import CHANNELS, MEASURED, SENSORS, foot_forces
from hexapod_sim.simulation import Simulation, _locate_blocks
from hexapod_sim.task import LineTask
from hexapod_sim.task_config import TaskConfig

from hexapod_sim import robot, sensors

NEUTRAL = np.tile(robot.NEUTRAL_POSE, (robot.SUBSTEPS, 1))
GRAVITY = 9.81
SIZES = {
    'joint_angles': (18,),
    'joint_velocities': (18,),
    'joint_torques': (18,),
    'linear_velocity': (3,),
    'orientation': (4,),
    'angular_velocity': (3,),
    'linear_acceleration': (3,),
    'height': (1,),
    'foot_contacts': (6,),
    'foot_wrench': (6, 3),
}


@pytest.fixture(scope='module')
def simulation() -> Simulation:
    return Simulation()


@pytest.fixture
def standing(simulation: Simulation) -> Simulation:
    simulation.reset(0.0)
    return simulation


def read(simulation: Simulation, channel: str) -> np.ndarray:
    return sensors.read(simulation, [channel])[channel]


def place(
    simulation: Simulation,
    z: float | None = None,
    quaternion: object = None,
    joints: object = None,
    velocity: object = 0.0,
) -> None:
    """Change parts of the configuration and recompute what the sensors see."""
    qpos = simulation.data.qpos
    for where, value in ((2, z), (slice(3, 7), quaternion), (slice(7, None), joints)):
        if value is not None:
            qpos[where] = value
    simulation.data.qvel[:] = velocity
    mujoco.mj_forward(simulation.model, simulation.data)


def test_channels_have_their_sizes_and_are_copies(standing: Simulation) -> None:
    readings = sensors.read(standing, SIZES)
    assert set(SIZES) == set(MEASURED)
    for channel, reading in readings.items():
        assert reading.shape == SIZES[channel], channel
        assert reading.dtype == np.float64
        assert not np.shares_memory(reading, standing.data.sensordata)


def test_unknown_channel_is_named(standing: Simulation) -> None:
    with pytest.raises(ValueError, match="sensor reading 'smell': expected one of joint_angles"):
        sensors.read(standing, ['height', 'smell'])


def test_every_channel_is_made_of_sensors_of_the_model(standing: Simulation) -> None:
    covered = np.zeros(standing.model.nsensordata, dtype=int)
    # Forces and contacts are made of the same sensors of the feet.
    for start, stop in {(block.start, block.stop) for block in standing.sensor_blocks.values()}:
        covered[start:stop] += 1
    np.testing.assert_array_equal(covered, 1)


def test_scattered_sensors_are_refused() -> None:
    spec = mujoco.MjSpec.from_string(
        '<mujoco><worldbody><body><joint name="a"/><geom size="1"/></body></worldbody>'
        '<sensor><jointpos name="lf_hip_angle" joint="a"/><clock name="clock"/>'
        + ''.join(f'<jointpos name="{j}_angle" joint="a"/>' for j in robot.JOINTS[1:])
        + '</sensor></mujoco>'
    )
    with pytest.raises(ValueError, match="sensors of 'joint_angles': expected them in a row"):
        _locate_blocks(spec.compile())


def test_joint_readings_are_the_joints(standing: Simulation) -> None:
    angles = robot.NEUTRAL_POSE + np.linspace(-0.1, 0.1, 18)
    speeds = np.linspace(-1.0, 1.0, 18)
    place(standing, joints=angles, velocity=np.concatenate((np.zeros(6), speeds)))
    np.testing.assert_array_equal(read(standing, 'joint_angles'), angles)
    np.testing.assert_array_equal(read(standing, 'joint_velocities'), speeds)


def test_torque_pulls_towards_the_target(standing: Simulation) -> None:
    # In the linear range the drive gives kp times the position error.
    targets = robot.NEUTRAL_POSE + np.linspace(-0.04, 0.04, 18)
    standing.advance(np.tile(targets, (robot.SUBSTEPS, 1)))
    error = targets - read(standing, 'joint_angles')
    np.testing.assert_allclose(read(standing, 'joint_torques'), robot.SERVO_KP * error, rtol=1e-6)


def test_torque_is_limited(standing: Simulation) -> None:
    standing.advance(np.tile(robot.NEUTRAL_POSE + 0.5, (robot.SUBSTEPS, 1)))
    torques = read(standing, 'joint_torques')
    assert torques.max() == robot.TORQUE_LIMIT
    standing.reset(0.0)
    standing.advance(np.tile(robot.NEUTRAL_POSE - 0.5, (robot.SUBSTEPS, 1)))
    assert read(standing, 'joint_torques').min() == -robot.TORQUE_LIMIT


def test_standing_knees_push_the_feet_down(standing: Simulation) -> None:
    # Positive knee angles raise the foot, so carrying the body takes negative torques.
    assert np.all(read(standing, 'joint_torques')[1::3] < 0)


def test_accelerometer_reads_specific_force_upwards_at_rest(standing: Simulation) -> None:
    np.testing.assert_allclose(read(standing, 'linear_acceleration'), [0, 0, GRAVITY], atol=1e-3)


def test_accelerometer_reads_nothing_in_free_fall(standing: Simulation) -> None:
    standing.data.ctrl[:] = robot.NEUTRAL_POSE
    place(standing, z=1.0, joints=robot.NEUTRAL_POSE)
    np.testing.assert_allclose(read(standing, 'linear_acceleration'), 0.0, atol=1e-9)


def test_accelerometer_tilts_with_the_body(standing: Simulation) -> None:
    # Rolled by +90 degrees (left side up), gravity's reaction points along +y of the body;
    # held still by an applied force, so that the specific force is the reaction alone.
    roll = [np.cos(np.pi / 4), np.sin(np.pi / 4), 0, 0]
    place(standing, z=1.0, quaternion=roll, joints=robot.NEUTRAL_POSE)
    free_fall = read(standing, 'linear_acceleration')
    standing.data.qfrc_applied[:] = standing.data.qfrc_bias
    mujoco.mj_forward(standing.model, standing.data)
    held = read(standing, 'linear_acceleration')
    np.testing.assert_allclose(held - free_fall, [0, GRAVITY, 0], atol=1e-6)


def test_quaternion_is_x_y_z_w(standing: Simulation) -> None:
    np.testing.assert_allclose(read(standing, 'orientation'), [0, 0, 0, 1], atol=1e-12)
    standing.reset(0.0, yaw=np.pi / 2)
    np.testing.assert_allclose(
        read(standing, 'orientation'), [0, 0, np.sqrt(0.5), np.sqrt(0.5)], atol=1e-12
    )


def test_velocities_are_in_the_body_frame(standing: Simulation) -> None:
    # Heading +y of odom and moving along +y of odom: forwards in the body.
    standing.reset(0.0, yaw=np.pi / 2)
    twist = np.zeros(24)
    twist[:3] = 0.0, 0.3, 0.0
    place(standing, z=0.5, velocity=twist)
    np.testing.assert_allclose(read(standing, 'linear_velocity'), [0.3, 0, 0], atol=1e-12)
    # Turning about odom's x axis is turning about the body's -y.
    rotation = np.zeros(24)
    rotation[3:6] = 0.0, -0.7, 0.0  # MuJoCo's free joint: angular velocity in the body frame
    place(standing, z=0.5, velocity=rotation)
    np.testing.assert_allclose(read(standing, 'angular_velocity'), [0, -0.7, 0], atol=1e-12)
    spin = np.zeros(3)
    mujoco.mju_rotVecQuat(spin, np.array([0, -0.7, 0]), standing.data.qpos[3:7])
    np.testing.assert_allclose(spin, [0.7, 0, 0], atol=1e-12)


def test_velocity_is_the_derivative_of_the_position(standing: Simulation) -> None:
    rng = np.random.default_rng(0)
    for _ in range(10):
        standing.advance(NEUTRAL + rng.uniform(-0.1, 0.1, 18))
    step = robot.PHYSICS_STEP_NS * 1e-9
    before = standing.data.qpos[:3].copy()
    mujoco.mj_step(standing.model, standing.data)
    mujoco.mj_forward(standing.model, standing.data)
    world = np.zeros(3)
    mujoco.mju_rotVecQuat(world, read(standing, 'linear_velocity'), standing.data.qpos[3:7])
    # Semi-implicit integration moves by the new velocity.
    np.testing.assert_allclose((standing.data.qpos[:3] - before) / step, world, atol=1e-9)


@pytest.mark.parametrize('line_y', [0.0, 5.0])
def test_height_is_the_distance_to_the_floor_and_not_to_the_goal_line(
    standing: Simulation, line_y: float
) -> None:
    standing.set_goal_line(line_y)
    place(standing, z=0.2)
    assert read(standing, 'height')[0] == np.float64(np.float32(0.2))


def test_height_of_a_pitched_body_is_measured_along_its_own_axis(standing: Simulation) -> None:
    pitch = 0.3
    tilt = [np.cos(pitch / 2), 0, np.sin(pitch / 2), 0]
    place(standing, z=0.2, quaternion=tilt)
    assert read(standing, 'height')[0] == pytest.approx(0.2 / np.cos(pitch), rel=1e-6)


def test_height_is_the_end_of_the_range_where_nothing_is_met(standing: Simulation) -> None:
    place(standing, z=0.5, quaternion=[0, 1, 0, 0])  # upside down
    assert read(standing, 'height')[0] == robot.HEIGHT_RANGE_MAX
    place(standing, z=3.0, quaternion=[1, 0, 0, 0])
    assert read(standing, 'height')[0] == robot.HEIGHT_RANGE_MAX


def test_height_survives_a_float32_message(standing: Simulation) -> None:
    height = read(standing, 'height')[0]
    assert np.float64(np.float32(height)) == height


def test_forces_at_rest_carry_the_weight(standing: Simulation) -> None:
    wrench = read(standing, 'foot_wrench')
    np.testing.assert_allclose(wrench.sum(axis=0), [0, 0, robot.TOTAL_MASS * GRAVITY], atol=1e-3)
    assert np.all(wrench[:, 2] > 0)
    # Mirror images of one another carry the same.
    np.testing.assert_allclose(wrench[:3, 2], wrench[3:, 2], rtol=1e-4)


def test_forces_accelerate_the_body(standing: Simulation) -> None:
    # Newton: the floor's forces are the total mass times (acceleration of the centre of mass + g).
    rng = np.random.default_rng(7)
    for _ in range(20):
        standing.advance(NEUTRAL + rng.uniform(-0.15, 0.15, 18))
    wrench = read(standing, 'foot_wrench')
    momentum = []
    step = 1e-6
    model, data = standing.model, standing.data
    acceleration = data.qacc.copy()
    for sign in (-1, 1):
        probe = mujoco.MjData(model)
        probe.qpos[:], probe.qvel[:] = data.qpos, data.qvel + sign * step * acceleration
        mujoco.mj_integratePos(model, probe.qpos, data.qvel, sign * step)
        mujoco.mj_forward(model, probe)
        mujoco.mj_subtreeVel(model, probe)
        momentum.append(robot.TOTAL_MASS * probe.subtree_linvel[0])
    rate = (momentum[1] - momentum[0]) / (2 * step)
    expected = rate + np.array([0, 0, robot.TOTAL_MASS * GRAVITY])
    np.testing.assert_allclose(wrench.sum(axis=0), expected, atol=0.02)


def test_friction_stays_inside_the_cone(standing: Simulation) -> None:
    rng = np.random.default_rng(8)
    for _ in range(40):
        standing.advance(NEUTRAL + rng.uniform(-0.25, 0.25, 18))
        forces = foot_forces(read(standing, 'foot_wrench'))
        normal, friction = forces[:6], forces[6:]
        assert np.all(friction <= standing.world.scene.friction * normal + 1e-6)


def test_foot_forces_of_hand_made_wrenches() -> None:
    wrench = np.zeros((6, 3))
    wrench[0] = 3.0, 4.0, 10.0  # friction 5 by Pythagoras
    wrench[4] = -6.0, 8.0, -2.0  # the sign of the normal depends on the device's mounting
    expected = [10, 0, 0, 0, 2, 0, 5, 0, 0, 0, 10, 0]
    np.testing.assert_array_equal(foot_forces(wrench), expected)


def test_foot_forces_are_made_of_the_wrench() -> None:
    task = LineTask(TaskConfig.of_article())
    task.reset(1)
    task.advance(NEUTRAL + 0.05)
    wrench = read(task.simulation, 'foot_wrench')
    observed = task.sensors.observe(CHANNELS)
    np.testing.assert_array_equal(foot_forces(wrench), observed['foot_forces'])


def test_contacts_name_the_feet_on_the_floor(standing: Simulation) -> None:
    np.testing.assert_array_equal(read(standing, 'foot_contacts'), 1)
    lifted = standing.data.qpos[7:].copy()
    lifted[robot.JOINTS.index('rf_knee')] += 0.3
    lifted[robot.JOINTS.index('lm_knee')] += 0.3
    place(standing, joints=lifted)
    np.testing.assert_array_equal(read(standing, 'foot_contacts'), [1, 0, 1, 0, 1, 1])
    np.testing.assert_array_equal(read(standing, 'foot_wrench')[[1, 3]], 0)


BAD = Quality(noise=0.05, bias=0.1, delay=0.06, dropout=0.3, quantisation=0.01, rate=20.0)
SWITCHES = replace(PERFECT, noise=0.1, dropout=0.2)


def walk(qualities, steps: int = 30, seed: int = 3):
    """Return outcomes and observations of a robot that moves its legs at random."""
    task, rng = LineTask(TaskConfig.of_article(), qualities), np.random.default_rng(1)
    outcomes, seen = [task.reset(seed)], [task.sensors.observe(CHANNELS)]
    for _ in range(steps):
        outcomes.append(task.advance(NEUTRAL + rng.uniform(-0.1, 0.1, 18)))
        seen.append(task.sensors.observe(CHANNELS))
    return outcomes, seen


def test_bad_sensors_are_read_and_the_truth_is_judged() -> None:
    bad = dict.fromkeys(SENSORS, BAD) | {'foot_contacts': SWITCHES}
    outcomes, seen = walk(bad)
    expected, truth = walk({})
    assert outcomes == expected
    for reading in truth[0]:
        assert any((a[reading] != b[reading]).any() for a, b in zip(seen, truth, strict=True))


def test_the_errors_of_a_sensor_are_its_own() -> None:
    """However good the others are, and from episode to episode they differ."""
    one, all_bad, again = (
        walk({'imu_data': BAD})[1],
        walk(dict.fromkeys(SENSORS, BAD) | {'foot_contacts': SWITCHES})[1],
        walk({'imu_data': BAD}, seed=4)[1],
    )
    for ours, theirs in zip(one, all_bad, strict=True):
        np.testing.assert_array_equal(ours['orientation'], theirs['orientation'])
    assert (one[0]['orientation'] != again[0]['orientation']).any()


def test_one_load_cell_of_six_loses_a_sample() -> None:
    _, seen = walk({'foot_force': replace(PERFECT, dropout=0.5)})
    _, truth = walk({})
    late = np.array(
        [
            (ours['foot_forces'] != theirs['foot_forces'])[:6]
            for ours, theirs in zip(seen, truth, strict=True)
        ]
    )
    assert (late.any(axis=1) & ~late.all(axis=1)).any()


def test_a_copy_of_a_task_goes_on_with_its_errors() -> None:
    task = LineTask(TaskConfig.of_article(), {'imu_data': BAD})
    task.reset(3)
    for _ in range(5):
        task.advance(NEUTRAL)
    for twin in (copy.deepcopy(task), pickle.loads(pickle.dumps(task))):
        mine = copy.deepcopy(task)
        for _ in range(10):
            mine.advance(NEUTRAL)
            twin.advance(NEUTRAL)
            ours, theirs = (each.sensors.observe(CHANNELS)['orientation'] for each in (mine, twin))
            np.testing.assert_array_equal(ours, theirs)
