# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Variations of the robot: what statics and the sensors say of them, and faults on the way."""

import copy
from dataclasses import fields

import mujoco
import numpy as np
import pytest
from hexapod_node.parameters import config_table
from hexapod_sim.scenes.table import SceneConfig
from hexapod_sim.sensors import read
from hexapod_sim.simulation import Simulation
from hexapod_sim.variations.table import VARIATIONS, RobotConfig
from hexapod_sim.world import World

from hexapod_sim import robot

NEUTRAL = np.tile(robot.NEUTRAL_POSE, (robot.SUBSTEPS, 1))
LF = slice(0, 3)
KINDS = {
    'payload': {'payload': 1.2, 'payload_x': 0.05},
    'motor_strength': {'motor_strength': 0.7},
    'dead_legs': {'dead_legs': 'lf+rr'},
    'missing_legs': {'missing_legs': 'lm'},
    'blocked_joints': {'blocked_joints': 'lf_knee', 'blocked_angle': 0.8},
}


def built(**changes) -> Simulation:
    return Simulation(World(SceneConfig.of_article(), RobotConfig.of_article(**changes)))


def shaken(simulation: Simulation, periods: int, seed: int = 4) -> list[np.ndarray]:
    """Return the states that targets around the standing pose lead to."""
    rng = np.random.default_rng(seed)
    states = []
    for _ in range(periods):
        simulation.advance(NEUTRAL + rng.uniform(-0.2, 0.2, NEUTRAL.shape))
        states.append(np.concatenate((simulation.data.qpos, simulation.data.qvel)))
    return states


def resting_height(load: float) -> float:
    """Return the height of a standing body that carries a load [kg], by statics of one leg.

    The floor bears each leg vertically, once the feet have crept; each servo gives way by torque
    over stiffness. Links hang in the middle of their length.
    """
    knee, ankle = robot.NEUTRAL_LEG[1:]
    masses = robot.FEMUR_MASS, robot.TIBIA_MASS, robot.FOOT_MASS
    floor = (robot.TOTAL_MASS + load) / len(robot.LEGS)
    for _ in range(50):
        femur = robot.FEMUR_LENGTH * np.cos(knee)
        tibia = robot.TIBIA_LENGTH * np.sin(knee + ankle)
        places = np.array([femur / 2, femur + tibia / 2, femur + tibia])
        at_knee = floor * (femur + tibia) - masses @ places
        at_ankle = floor * tibia - np.array(masses[1:]) @ (places[1:] - femur)
        knee = robot.NEUTRAL_LEG[1] + robot.GRAVITY * at_knee / robot.SERVO_KP
        ankle = robot.NEUTRAL_LEG[2] + robot.GRAVITY * at_ankle / robot.SERVO_KP
    drop = robot.TIBIA_LENGTH * np.cos(knee + ankle) - robot.FEMUR_LENGTH * np.sin(knee)
    return drop + robot.FOOT_RADIUS


def test_each_option_has_its_range_or_names() -> None:
    table = {entry.name: entry for entry in config_table(RobotConfig.of_article(), 'robot')}
    assert set(table) == {f'robot.{field.name}' for field in fields(RobotConfig)}
    assert all(entry.description for entry in table.values())
    texts = {name for name, entry in table.items() if not entry.range}
    assert texts == {'robot.dead_legs', 'robot.missing_legs', 'robot.blocked_joints'}


def test_the_robot_of_the_article_has_no_variation() -> None:
    config = RobotConfig.of_article()
    assert config.variations == []
    assert config.undamaged == config
    assert World.of_article().build()[2] is None


def test_each_kind_has_a_case_here() -> None:
    kinds = [type(*RobotConfig.of_article(**changes).variations) for changes in KINDS.values()]
    assert kinds == [*sorted(VARIATIONS, key=kinds.index)]


@pytest.mark.parametrize('load', [0.0, 0.6, 1.2, 2.4])
def test_a_payload_lowers_the_body_as_statics_says(load: float) -> None:
    simulation = built(payload=load)
    soft = -simulation.data.contact.dist.mean()  # the floor gives way, too
    assert soft < 6e-4
    assert simulation.position[2] == pytest.approx(resting_height(load) - soft, abs=5e-5)
    forces = read(simulation, ('foot_wrench',))['foot_wrench'].sum(axis=0)
    weight = (robot.TOTAL_MASS + load) * robot.GRAVITY
    np.testing.assert_allclose(forces, [0.0, 0.0, weight], atol=0.02 * weight)


def test_a_payload_has_its_inertia_and_lever_arm() -> None:
    """Of a cube, m a^2 / 6 about its centre (Steiner for the body's axes)."""
    sound, loaded = built(), built(payload=2.0, payload_x=0.1, payload_z=0.2, payload_edge=0.3)
    body = {}
    for name, simulation in (('sound', sound), ('loaded', loaded)):
        base = simulation.model.body('base_link')
        body[name] = base.mass[0], base.ipos.copy()
    assert body['loaded'][0] - body['sound'][0] == pytest.approx(2.0)
    centre = body['loaded'][1] * body['loaded'][0] - body['sound'][1] * body['sound'][0]
    np.testing.assert_allclose(centre / 2.0, [0.1, 0.0, 0.2], atol=1e-9)
    turn = []
    for simulation in (sound, loaded):
        mass = np.zeros((simulation.model.nv,) * 2)
        simulation.data.qpos[3:7] = 1.0, 0.0, 0.0, 0.0
        mujoco.mj_forward(simulation.model, simulation.data)
        mujoco.mj_fullM(simulation.model, simulation.data, mass)
        turn.append(mass[5, 5])  # about base_link's z axis
    assert turn[1] - turn[0] == pytest.approx(2.0 * 0.3**2 / 6 + 2.0 * 0.1**2, rel=0.05)


def test_a_dead_leg_carries_no_torque() -> None:
    simulation = built(dead_legs='lf')
    for _ in shaken(simulation, 20):
        torques = read(simulation, ('joint_torques',))['joint_torques']
        assert not torques[LF].any()
        assert torques[3:].all()


def test_a_missing_leg_bears_and_weighs_nothing() -> None:
    simulation = built(missing_legs='lf')
    weight = (robot.TOTAL_MASS - 0.22) * robot.GRAVITY  # coxa, femur, tibia and foot
    mass = simulation.model.body('base_link').subtreemass[0]
    assert mass * robot.GRAVITY == pytest.approx(weight)
    angles = read(simulation, ('joint_angles',))['joint_angles'][LF].copy()
    for _ in range(80):
        simulation.advance(NEUTRAL)
    readings = read(simulation, ('foot_contacts', 'foot_wrench', 'joint_torques', 'joint_angles'))
    assert readings['foot_contacts'].tolist() == [0, 1, 1, 1, 1, 1]
    assert not readings['foot_wrench'][0].any()
    assert not readings['joint_torques'][LF].any()
    np.testing.assert_allclose(readings['joint_angles'][LF], angles, atol=0.02)
    np.testing.assert_allclose(readings['foot_wrench'].sum(axis=0), [0, 0, weight], atol=0.2)


def test_a_blocked_joint_stays_where_it_is_stuck() -> None:
    simulation = built(blocked_joints='lf_knee+rm_hip', blocked_angle=0.5)
    stuck = [robot.JOINTS.index(name) for name in ('lf_knee', 'rm_hip')]
    for _ in shaken(simulation, 40):
        angles = read(simulation, ('joint_angles',))['joint_angles']
        np.testing.assert_allclose(angles[stuck], 0.5, atol=5e-3)


def test_weak_motors_give_less_torque_at_the_same_error() -> None:
    torques = []
    for strength in (1.0, 0.7):
        simulation = built(motor_strength=strength)
        simulation.data.qpos[2] += 0.2  # in the air, so that the angles are the same
        simulation.advance(NEUTRAL)
        torques.append(simulation.model.actuator_forcerange[:, 1].copy())
    np.testing.assert_allclose(torques[1], 0.7 * torques[0])
    sags = [robot.STANDING_HEIGHT - built(motor_strength=s).position[2] for s in (1.0, 0.7)]
    assert sags[1] / sags[0] == pytest.approx(1 / 0.7, rel=0.1)


@pytest.mark.parametrize('kind', KINDS)
def test_a_varied_robot_begins_at_rest(kind: str) -> None:
    simulation = built(**KINDS[kind])
    start = simulation.data.qpos.copy()
    for _ in range(40):
        simulation.advance(NEUTRAL)
    np.testing.assert_allclose(simulation.data.qpos[:7], start[:7], atol=2e-3)


@pytest.mark.parametrize('kind', KINDS)
def test_before_the_fault_it_is_the_sound_robot(kind: str) -> None:
    """Not to the last bit: room for a constraint may order sums otherwise."""
    varied, sound = built(**KINDS[kind], fault_time=0.25), built()
    before = 10
    np.testing.assert_allclose(shaken(varied, before), shaken(sound, before), atol=1e-9)
    after = [shaken(each, 10, seed=5)[-1] for each in (varied, sound)]
    assert np.abs(after[0] - after[1]).max() > 1e-4


@pytest.mark.parametrize('kind', KINDS)
def test_after_the_fault_the_model_is_the_varied_one(kind: str) -> None:
    """Every number of it, so that nothing but the state differs from a robot varied all along."""
    later, always = built(**KINDS[kind], fault_time=0.025), built(**KINDS[kind])
    shaken(later, 2)
    for name in dir(always.model):
        numbers = getattr(always.model, name)
        if isinstance(numbers, np.ndarray):
            np.testing.assert_array_equal(getattr(later.model, name), numbers, name)
    np.testing.assert_array_equal(later.data.eq_active, always.data.eq_active)
    assert later.model.stat.meaninertia == always.model.stat.meaninertia


@pytest.mark.parametrize('kind', KINDS)
def test_a_reset_mends_the_robot(kind: str) -> None:
    simulation = built(**KINDS[kind], fault_time=0.1)
    walks = []
    for _ in range(2):
        simulation.reset(0.1)
        walks.append(shaken(simulation, 8))
    np.testing.assert_array_equal(*walks)


def test_a_copy_goes_on_through_the_fault() -> None:
    simulation = built(**KINDS['missing_legs'], fault_time=0.1)
    shaken(simulation, 3)
    np.testing.assert_array_equal(
        shaken(copy.deepcopy(simulation), 5, seed=6), shaken(simulation, 5, seed=6)
    )


@pytest.mark.parametrize(
    ('changes', 'message'),
    [
        ({'dead_legs': 'lx'}, r'robot.dead_legs: expected none, or some of lf, lm'),
        ({'missing_legs': 'lf+lf'}, 'robot.missing_legs: expected none'),
        ({'blocked_joints': 'lf_toe'}, 'some of lf_hip, lf_knee'),
        ({'blocked_joints': 'lf_hip', 'blocked_angle': 1.0}, r'blocked_angle is 1.0, .* lf_hip'),
    ],
)
def test_what_cannot_be_is_named(changes, message) -> None:
    with pytest.raises(ValueError, match=message):
        RobotConfig.of_article(**changes)
