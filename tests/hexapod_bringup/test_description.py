# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The URDF is the robot of the compiled MuJoCo model."""

import math
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest
from hexapod_bringup.description import description_of
from hexapod_sim.simulation import Simulation
from hexapod_sim.variations.table import RobotConfig
from robot_urdf import capsule_inertia, robot_description

from hexapod_sim import robot

FILE = Path(__file__).resolve().parents[2] / 'ros_ws/src/hexapod_bringup/urdf/hexapod.urdf'
PARTS = ('coxa', 'femur', 'tibia')
BODIES = [f'{leg}_{part}' for leg in robot.LEGS for part in PARTS]


@pytest.fixture(scope='module')
def urdf() -> ElementTree.Element:
    return ElementTree.fromstring(robot_description().split('?>', 1)[1])


@pytest.fixture(scope='module')
def mjcf() -> mujoco.MjModel:
    return Simulation().model


@pytest.fixture(scope='module')
def imported() -> mujoco.MjModel:
    """The URDF as MuJoCo's own importer understands it: the body is fixed to the world."""
    return mujoco.MjModel.from_xml_string(robot_description())


def floats(element: ElementTree.Element, path: str, attribute: str) -> list[float]:
    return [float(word) for word in element.find(path).get(attribute).split()]


def inertia(model: mujoco.MjModel, body: str) -> np.ndarray:
    """Inertia tensor about the centre of mass, in the axes of the body."""
    axes = np.empty(9)
    mujoco.mju_quat2Mat(axes, model.body(body).iquat)
    axes = axes.reshape(3, 3)
    return axes @ np.diag(model.body(body).inertia) @ axes.T


def test_shipped_file_is_the_one_made_of_the_numbers() -> None:
    assert FILE.read_text(encoding='utf-8') == robot_description(), (
        'run python tests/support/robot_urdf.py ros_ws/src/hexapod_bringup/urdf/hexapod.urdf'
    )


def test_joints_and_limits(urdf, mjcf) -> None:
    moving = [joint for joint in urdf.iter('joint') if joint.get('type') == 'revolute']
    assert [joint.get('name') for joint in moving] == list(robot.JOINTS)
    for joint in moving:
        name = joint.get('name')
        there, servo = mjcf.joint(name), mjcf.actuator(name)
        body = mjcf.body(there.bodyid[0])
        assert joint.find('child').get('link') == body.name
        assert joint.find('parent').get('link') == mjcf.body(body.parentid[0]).name
        limit = joint.find('limit').attrib
        assert [float(limit[end]) for end in ('lower', 'upper')] == there.range.tolist()
        assert float(limit['effort']) == servo.forcerange[1]
        assert float(limit['velocity']) == robot.NO_LOAD_SPEED
        damping = float(joint.find('dynamics').get('damping'))
        assert damping == pytest.approx(there.damping[0], rel=1e-7)
        assert floats(joint, 'axis', 'xyz') == there.axis.tolist()
        np.testing.assert_allclose(floats(joint, 'origin', 'xyz'), body.pos, atol=1e-12)
        roll, pitch, yaw = floats(joint, 'origin', 'rpy')
        assert roll == pitch == 0.0
        expected = [math.cos(yaw / 2), 0, 0, math.sin(yaw / 2)]
        np.testing.assert_allclose(body.quat, expected, atol=1e-7)


def test_independent_importer_finds_the_same_legs_in_any_pose(mjcf, imported) -> None:
    here, there = mujoco.MjData(imported), mujoco.MjData(mjcf)
    generator = np.random.default_rng(2)
    assert [imported.joint(i).name for i in range(imported.njnt)] == list(robot.JOINTS)
    for _ in range(5):
        angles = generator.uniform(robot.JOINT_LOWER, robot.JOINT_UPPER)
        here.qpos[:] = angles
        there.qpos[:] = [0, 0, 0, 1, 0, 0, 0, *angles]
        mujoco.mj_forward(imported, here)
        mujoco.mj_forward(mjcf, there)
        for body in BODIES:
            np.testing.assert_allclose(here.body(body).xpos, there.body(body).xpos, atol=1e-7)
            np.testing.assert_allclose(here.body(body).xmat, there.body(body).xmat, atol=1e-7)


@pytest.mark.parametrize('body', BODIES)
def test_masses_and_inertias_of_the_legs(mjcf, imported, body) -> None:
    ours, theirs = imported.body(body), mjcf.body(body)
    assert ours.mass[0] == pytest.approx(theirs.mass[0], rel=1e-12)
    np.testing.assert_allclose(ours.ipos, theirs.ipos, atol=1e-12)
    np.testing.assert_allclose(inertia(imported, body), inertia(mjcf, body), rtol=1e-9, atol=1e-15)


def test_mass_and_inertia_of_the_body(urdf, mjcf) -> None:
    link = urdf.find("link[@name='base_link']")
    assert float(link.find('inertial/mass').get('value')) == robot.BODY_MASS
    moments = link.find('inertial/inertia').attrib
    tensor = np.diag([float(moments[key]) for key in ('ixx', 'iyy', 'izz')])
    np.testing.assert_allclose(tensor, inertia(mjcf, 'base_link'), rtol=1e-12)
    masses = [float(mass.get('value')) for mass in urdf.iter('mass')]
    assert sum(masses) == pytest.approx(robot.TOTAL_MASS)


def test_capsule_of_no_length_is_a_ball_and_a_long_one_a_rod() -> None:
    # Textbook: ball 2/5 m r^2; thin rod m l^2 / 12 across.
    assert capsule_inertia(2.0, 0.5, 0.0) == pytest.approx((0.2, 0.2))
    assert capsule_inertia(1.0, 1e-6, 3.0)[0] == pytest.approx(0.75, rel=1e-5)


def test_what_collides_is_what_does_in_the_simulation(urdf, mjcf) -> None:
    solid = {
        mjcf.body(mjcf.geom_bodyid[i]).name: mjcf.geom(i)
        for i in range(mjcf.ngeom)
        if mjcf.geom_contype[i]
    }
    found = {link.get('name'): link for link in urdf.iter('link') if link.find('collision')}
    assert found.keys() == solid.keys()
    for name, link in found.items():
        (collision,) = link.findall('collision')
        geom = solid[name]
        np.testing.assert_allclose(floats(collision, 'origin', 'xyz'), geom.pos)
        if name == robot.BASE_FRAME:
            size = np.array(floats(collision, 'geometry/box', 'size')) / 2
            np.testing.assert_allclose(size, geom.size)
        else:
            assert floats(collision, 'geometry/sphere', 'radius') == [geom.size[0]]


@pytest.mark.parametrize('body', BODIES)
def test_links_look_like_the_capsules_of_the_model(urdf, mjcf, body) -> None:
    geom = mjcf.geom(body)
    cylinder, *ends = urdf.find(f"link[@name='{body}']").findall('visual')[:3]
    assert floats(cylinder, 'geometry/cylinder', 'radius') == [geom.size[0]]
    (length,) = floats(cylinder, 'geometry/cylinder', 'length')
    assert length == pytest.approx(2 * geom.size[1])
    np.testing.assert_allclose(floats(cylinder, 'origin', 'xyz'), geom.pos, atol=1e-12)
    roll, pitch, yaw = floats(cylinder, 'origin', 'rpy')
    assert roll == yaw == 0.0
    axes = np.empty(9)
    mujoco.mju_quat2Mat(axes, geom.quat)
    axis = axes.reshape(3, 3)[:, 2]
    np.testing.assert_allclose(np.abs(axis), [math.sin(pitch), 0, math.cos(pitch)], atol=1e-12)
    middles = [floats(end, 'origin', 'xyz') for end in ends]
    np.testing.assert_allclose(np.ptp(middles, axis=0), length * np.abs(axis), atol=1e-12)


def test_the_rest_of_the_body_looks_like_the_model(urdf, mjcf) -> None:
    _, waist, deck, nose = urdf.find("link[@name='base_link']").findall('visual')
    sizes = {
        'body_waist': [
            *floats(waist, 'geometry/cylinder', 'radius'),
            floats(waist, 'geometry/cylinder', 'length')[0] / 2,
        ],
        'body_deck': [side / 2 for side in floats(deck, 'geometry/box', 'size')],
        'body_nose': floats(nose, 'geometry/sphere', 'radius'),
    }
    for (name, size), visual in zip(sizes.items(), (waist, deck, nose), strict=True):
        geom = mjcf.geom(name)
        np.testing.assert_allclose(geom.size[: len(size)], size)
        np.testing.assert_allclose(floats(visual, 'origin', 'xyz'), geom.pos)
        material = mjcf.material(geom.matid[0])
        assert visual.find('material').get('name') == material.name
        colour = urdf.find(f"material[@name='{material.name}']")
        np.testing.assert_allclose(floats(colour, 'color', 'rgba'), material.rgba, rtol=1e-6)


def test_devices_are_where_the_model_has_them(urdf, mjcf) -> None:
    for frame in (robot.IMU_FRAME, robot.HEIGHT_FRAME):
        joint = urdf.find(f"joint[@name='{frame}_mount']")
        np.testing.assert_array_equal(floats(joint, 'origin', 'xyz'), mjcf.site(frame).pos)
    # A ROS range finder looks along x, MuJoCo's along z.
    _, pitch, _ = floats(urdf.find("joint[@name='height_link_mount']"), 'origin', 'rpy')
    axes = np.empty(9)
    mujoco.mju_quat2Mat(axes, mjcf.site(robot.HEIGHT_FRAME).quat)
    looks = [math.cos(pitch), 0, -math.sin(pitch)]
    np.testing.assert_allclose(axes.reshape(3, 3)[:, 2], looks, atol=1e-12)


def test_as_built_the_description_is_the_shipped_one() -> None:
    assert description_of(robot_description(), RobotConfig.of_article()) == robot_description()
    strong = RobotConfig.of_article(motor_strength=0.7)
    assert ElementTree.canonicalize(
        description_of(robot_description(), strong), strip_text=True
    ) == ElementTree.canonicalize(robot_description(), strip_text=True)


def test_a_payload_has_its_place_mass_and_inertia(imported: mujoco.MjModel) -> None:
    config = RobotConfig.of_article(payload=1.2, payload_x=0.05, payload_edge=0.1)
    text = description_of(robot_description(), config)
    assert mujoco.MjModel.from_xml_string(text).njnt == imported.njnt
    root = ElementTree.fromstring(text)
    link, mount = root.find("link[@name='payload']"), root.find("joint[@name='payload_mount']")
    assert floats(link, 'inertial/mass', 'value') == [1.2]
    assert floats(link, 'inertial/inertia', 'ixx') == pytest.approx([1.2 * 0.1**2 / 6])
    assert floats(link, 'visual/geometry/box', 'size') == [0.1, 0.1, 0.1]
    assert floats(mount, 'origin', 'xyz')[0] == 0.05
    assert mount.find('parent').get('link') == robot.BASE_FRAME


def test_dead_legs_are_red_and_missing_ones_leave_their_frames(imported: mujoco.MjModel) -> None:
    config = RobotConfig.of_article(dead_legs='lf', missing_legs='rm')
    root = ElementTree.fromstring(description_of(robot_description(), config))
    links = {link.get('name', ''): link for link in root.iter('link')}
    colours = {
        name: {colour.get('rgba') for colour in link.findall('visual/material/color')}
        for name, link in links.items()
    }
    assert {name for name, found in colours.items() if found} == {
        'lf_coxa', 'lf_femur', 'lf_tibia',
    }  # fmt: skip
    assert colours['lf_coxa'] == {'0.75 0.16 0.14 1.0'}
    empty = {name for name, link in links.items() if len(link) == 0}
    assert {'rm_coxa', 'rm_femur', 'rm_tibia'} <= empty
    assert 'lm_coxa' not in empty
    joints = [joint.get('name') for joint in root.iter('joint')]
    assert joints == [
        joint.get('name')
        for joint in ElementTree.fromstring(robot_description().split('?>', 1)[1]).iter('joint')
    ]
