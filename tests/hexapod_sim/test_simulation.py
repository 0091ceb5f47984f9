# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Physics: naming, rest, determinism, reset hygiene, step convergence and clear failures."""

import copy
import math
import pickle
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hexapod_sim.simulation import Simulation, SimulationDivergedError, whole_ratio

from hexapod_sim import robot, sensors

NEUTRAL = np.tile(robot.NEUTRAL_POSE, (robot.SUBSTEPS, 1))


@pytest.fixture(scope='module')
def simulation() -> Simulation:
    return Simulation()


def wiggle(seed: int, periods: int) -> np.ndarray:
    """Joint targets (periods, SUBSTEPS, 18) around the neutral pose that shake the robot."""
    rng = np.random.default_rng(seed)
    return NEUTRAL + rng.uniform(-0.25, 0.25, (periods, robot.SUBSTEPS, len(robot.JOINTS)))


def record(simulation: Simulation, targets: np.ndarray) -> np.ndarray:
    """All sensor values after each period."""
    rows = []
    for target in targets:
        simulation.advance(target)
        rows.append(simulation.data.sensordata.copy())
    return np.array(rows)


def foot_position(simulation: Simulation, leg: str) -> np.ndarray:
    return simulation.data.site(f'{leg}_foot').xpos.copy()


@pytest.mark.parametrize(
    'kind', ['body', 'joint', 'geom', 'site', 'sensor', 'actuator', 'camera', 'light', 'material']
)
def test_every_element_has_a_name(simulation: Simulation, kind: str) -> None:
    model = simulation.model
    counts = {'body': 'nbody', 'joint': 'njnt', 'actuator': 'nu', 'camera': 'ncam'}
    count = getattr(model, counts.get(kind, {'material': 'nmat'}.get(kind, f'n{kind}')))
    names = [getattr(model, kind)(i).name for i in range(count)]
    assert count > 0
    assert all(names)
    assert len(set(names)) == count


def test_cameras(simulation: Simulation) -> None:
    model = simulation.model
    assert {model.camera(i).name for i in range(model.ncam)} == {'track', 'top'}


def test_keyframe_touches_the_floor_without_penetration(simulation: Simulation) -> None:
    data = mujoco.MjData(simulation.model)
    mujoco.mj_resetDataKeyframe(simulation.model, data, simulation.model.key('standing').id)
    mujoco.mj_forward(simulation.model, data)
    clearance = [data.site(f'{leg}_foot').xpos[2] - robot.FOOT_RADIUS for leg in robot.LEGS]
    np.testing.assert_allclose(clearance, 0.0, atol=1e-6)
    assert all(contact.dist >= -1e-6 for contact in data.contact)


def test_reset_stands_still_on_six_feet(simulation: Simulation) -> None:
    simulation.reset(0.3)
    before = simulation.data.qpos.copy()
    for _ in range(40):
        simulation.advance(NEUTRAL)
    # One second: less than a micrometre and a microradian.
    assert np.abs(simulation.data.qpos - before).max() < 1e-6
    assert sensors.read(simulation, ['foot_contacts'])['foot_contacts'].sum() == 6


def test_reset_places_and_turns_the_robot(simulation: Simulation) -> None:
    simulation.reset(-0.4, yaw=0.5)
    x, y, z, roll, pitch, yaw = simulation.pose()
    assert (x, y) == (0.0, -0.4)
    # The servos give by the weight: a little under the height of the rigid pose.
    assert 0.95 * robot.STANDING_HEIGHT < z < robot.STANDING_HEIGHT
    np.testing.assert_allclose((roll, pitch, yaw), (0, 0, 0.5), atol=1e-12)
    np.testing.assert_allclose(
        simulation.orientation, [0, 0, math.sin(0.25), math.cos(0.25)], atol=1e-12
    )
    np.testing.assert_array_equal(simulation.position, [x, y, z])


def test_pose_angles_are_fixed_axis_roll_pitch_yaw(simulation: Simulation) -> None:
    roll, pitch, yaw = 0.3, -0.2, 1.1
    axes = np.eye(3)
    quaternion = np.array([1.0, 0, 0, 0])
    for axis, angle in zip(axes, (roll, pitch, yaw), strict=True):
        turn, product = np.zeros(4), np.zeros(4)
        mujoco.mju_axisAngle2Quat(turn, axis, angle)
        mujoco.mju_mulQuat(product, turn, quaternion)
        quaternion = product
    simulation.reset(0.0)
    simulation.data.qpos[3:7] = quaternion
    np.testing.assert_allclose(simulation.pose()[3:], (roll, pitch, yaw), atol=1e-12)


@pytest.mark.parametrize(
    ('joint', 'axis', 'sign'),
    [
        # Left hip +: counter-clockwise about z, the foot at +y goes backwards.
        ('lm_hip', 0, -1),
        ('rm_hip', 0, 1),
        # Knee and ankle +: the foot rises, on both sides.
        ('lm_knee', 2, 1),
        ('rm_knee', 2, 1),
        ('lm_ankle', 2, 1),
        ('rm_ankle', 2, 1),
    ],
)
def test_signs_of_the_joints(simulation: Simulation, joint: str, axis: int, sign: int) -> None:
    leg = joint.split('_')[0]
    simulation.reset(0.0)
    before = foot_position(simulation, leg)
    simulation.data.joint(joint).qpos += 0.2
    mujoco.mj_kinematics(simulation.model, simulation.data)
    assert sign * (foot_position(simulation, leg) - before)[axis] > 0.001


def test_same_targets_give_the_same_bits() -> None:
    targets = wiggle(1, 60)
    np.testing.assert_array_equal(record(Simulation(), targets), record(Simulation(), targets))


def test_reset_forgets_everything(simulation: Simulation) -> None:
    targets = wiggle(2, 40)
    fresh = Simulation()
    fresh.reset(0.2, yaw=0.1)
    expected = record(fresh, targets)
    record(simulation, wiggle(3, 25))
    simulation.data.xfrc_applied[:] = 3.0
    simulation.data.qfrc_applied[:] = 1.0
    simulation.set_goal_line(0.7)
    simulation.reset(0.2, yaw=0.1)
    assert not simulation.data.mocap_pos.any()
    np.testing.assert_array_equal(record(simulation, targets), expected)


def test_period_equals_plain_steps_of_mujoco(simulation: Simulation) -> None:
    # The saved half step and the sensors read only once must not change the motion.
    targets = wiggle(4, 30)
    simulation.reset(0.0)
    plain = mujoco.MjData(simulation.model)
    plain.qpos[:], plain.ctrl[:] = simulation.data.qpos, simulation.data.ctrl
    for period in targets:
        simulation.advance(period)
        for target in period:
            plain.ctrl[:] = target
            mujoco.mj_step(simulation.model, plain)
        np.testing.assert_array_equal(simulation.data.qpos, plain.qpos)
        np.testing.assert_array_equal(simulation.data.qvel, plain.qvel)
    mujoco.mj_forward(simulation.model, plain)
    np.testing.assert_array_equal(simulation.data.sensordata, plain.sensordata)
    assert simulation.data.time == pytest.approx(30 * robot.CONTROL_PERIOD_NS * 1e-9)


def test_servo_reaches_no_more_than_its_no_load_speed(simulation: Simulation) -> None:
    simulation.reset(0.0)
    model = simulation.model
    data = mujoco.MjData(model)
    model.opt.gravity[:], flags = 0.0, model.opt.disableflags
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    try:
        data.ctrl[:] = robot.JOINT_UPPER
        for _ in range(30):
            mujoco.mj_step(model, data)
            assert np.abs(data.qvel[6:]).max() < robot.NO_LOAD_SPEED
            assert np.abs(data.actuator_force).max() <= robot.TORQUE_LIMIT
    finally:
        model.opt.gravity[2], model.opt.disableflags = -9.81, flags


@pytest.mark.parametrize('poison', [math.nan, 1e8])
def test_divergence_is_an_error_and_reset_repairs_it(
    poison: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # MuJoCo leaves its log of warnings where it runs
    simulation = Simulation()
    simulation.data.qvel[:] = poison
    mujoco.mj_forward(simulation.model, simulation.data)
    with pytest.raises(SimulationDivergedError, match='state diverged'):
        simulation.advance(NEUTRAL)
    simulation.reset(0.0)
    simulation.advance(NEUTRAL)
    np.testing.assert_array_equal(
        simulation.data.sensordata, record(Simulation(), NEUTRAL[None])[0]
    )


@pytest.mark.parametrize('shape', [(18,), (4, 18), (5, 17), (1, 5, 18)])
def test_targets_of_another_shape_are_refused(
    simulation: Simulation, shape: tuple[int, ...]
) -> None:
    with pytest.raises(ValueError, match=r'joint targets: expected shape \(5, 18\)'):
        simulation.advance(np.zeros(shape))


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf])
def test_targets_that_are_not_finite_are_refused(simulation: Simulation, value: float) -> None:
    targets = NEUTRAL.copy()
    targets[3, 7] = value
    with pytest.raises(ValueError, match='joint targets: expected finite angles'):
        simulation.advance(targets)


def test_goal_line_is_seen_and_touches_nothing(simulation: Simulation) -> None:
    simulation.reset(0.0)
    plain = record(simulation, wiggle(5, 20))
    simulation.reset(0.0)
    simulation.set_goal_line(0.25)
    np.testing.assert_array_equal(record(simulation, wiggle(5, 20)), plain)
    assert simulation.data.site('goal_line').xpos[1] == 0.25


def test_whole_ratio_refuses_what_does_not_divide() -> None:
    assert whole_ratio(5_000_000, 2_500_000) == 2
    with pytest.raises(ValueError, match='whole fraction of the period 5000000 ns'):
        whole_ratio(5_000_000, 2_000_000)
    with pytest.raises(ValueError, match='physics step 10000000 ns'):
        whole_ratio(5_000_000, 10_000_000)


@pytest.mark.parametrize('duplicate', [copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))])
def test_a_copy_goes_on_to_the_last_bit_and_by_itself(simulation: Simulation, duplicate) -> None:
    simulation.reset(0.2)
    record(simulation, wiggle(1, 20))
    twin, later = duplicate(simulation), wiggle(2, 20)
    assert twin.model is not simulation.model
    expected = record(simulation, later)
    record(simulation, wiggle(3, 5))  # does not move the copy
    np.testing.assert_array_equal(record(twin, later), expected)
