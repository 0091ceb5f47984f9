# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The robot as URDF, made of the numbers in robot.py, without meshes.

`python tests/support/robot_urdf.py ros_ws/src/hexapod_bringup/urdf/hexapod.urdf` writes the file
that hexapod_bringup ships; a test holds the file to this module, and both to the compiled MuJoCo
model.

A capsule is a cylinder with a sphere at each end. What collides is what does in the simulation:
the body's box and the feet. `<leg>_foot` frames keep their axes along odom, so no link has them.
"""

import math
from collections.abc import Sequence
from xml.etree import ElementTree

import numpy as np
from hexapod_sim.command_line import CommandLine, file
from numpy.typing import NDArray

from hexapod_sim import robot

Vector = Sequence[float] | NDArray[np.float64]
ORIGIN = (0.0, 0.0, 0.0)
# Colours of the simulation's materials, red green blue alpha.
_COLOURS = {
    'shell': '0.16 0.18 0.22 1',
    'trim': '0.24 0.27 0.33 1',
    'servo': '0.11 0.12 0.14 1',
    'accent': '0.93 0.46 0.13 1',
    'rubber': '0.05 0.05 0.05 1',
}
# Parts of the body that only show [m]: a waist, a deck and a nose.
_WAIST = (0.102, 0.018)  # radius, half height
_DECK = ((0.0, 0.0, 0.028), (0.085, 0.045, 0.006))  # centre, half sizes
_NOSE = ((0.128, 0.0, 0.004), 0.016)  # centre, radius

_ALONG_X = (0.0, math.pi / 2, 0.0)  # turns a cylinder's axis, z, to x
_HIP_AXIS = (0.0, 0.0, 1.0)
_PITCH_AXIS = (0.0, -1.0, 0.0)


def robot_description() -> str:
    """Return the URDF."""
    root = ElementTree.Element('robot', name='hexapod')
    for name, colour in _COLOURS.items():
        material = ElementTree.SubElement(root, 'material', name=name)
        ElementTree.SubElement(material, 'color', rgba=colour)
    _add_body(root)
    for index, leg in enumerate(robot.LEGS):
        _add_leg(root, index, leg)
    ElementTree.indent(root)
    note = '<!-- Written by tests/support/robot_urdf.py; do not edit. -->'
    text = ElementTree.tostring(root, encoding='unicode')
    return f'<?xml version="1.0"?>\n{note}\n{text}\n'


def _add_body(root: ElementTree.Element) -> None:
    body = add_link(root, robot.BASE_FRAME)
    a, b, c = (2.0 * half for half in robot.BODY_HALF_SIZE)
    squares = np.array([b * b + c * c, a * a + c * c, a * a + b * b])
    add_inertial(body, robot.BODY_MASS, ORIGIN, np.diag(robot.BODY_MASS / 12.0 * squares))
    for kind in ('visual', 'collision'):
        add_shape(body, 'box', {'size': numbers((a, b, c))}, 'shell', kind=kind)
    radius, half = _WAIST
    add_shape(body, 'cylinder', {'radius': str(radius), 'length': str(2 * half)}, 'trim')
    centre, halves = _DECK
    add_shape(body, 'box', {'size': numbers([2 * half for half in halves])}, 'accent', centre)
    centre, radius = _NOSE
    add_shape(body, 'sphere', {'radius': str(radius)}, 'accent', centre)
    # The frames of the devices. A range finder looks along its own x axis: here, down.
    for frame, angles in ((robot.IMU_FRAME, ORIGIN), (robot.HEIGHT_FRAME, _ALONG_X)):
        add_link(root, frame)
        joint = add_joint(root, f'{frame}_mount', 'fixed', robot.BASE_FRAME, frame)
        add_origin(joint, ORIGIN, angles)


def _add_leg(root: ElementTree.Element, index: int, leg: str) -> None:
    yaw = (0.0, 0.0, float(robot.HIP_YAWS[index]))
    places = (
        ('hip', robot.BASE_FRAME, 'coxa', robot.HIP_POSITIONS[index], yaw, _HIP_AXIS),
        ('knee', f'{leg}_coxa', 'femur', (robot.COXA_LENGTH, 0.0, 0.0), ORIGIN, _PITCH_AXIS),
        ('ankle', f'{leg}_femur', 'tibia', (robot.FEMUR_LENGTH, 0.0, 0.0), ORIGIN, _PITCH_AXIS),
    )
    for number, (name, parent, child, position, angles, axis) in enumerate(places):
        joint = add_joint(root, f'{leg}_{name}', 'revolute', parent, f'{leg}_{child}')
        add_origin(joint, position, angles)
        ElementTree.SubElement(joint, 'axis', xyz=numbers(axis))
        ElementTree.SubElement(
            joint,
            'limit',
            lower=str(float(robot.LEG_LOWER[number])),
            upper=str(float(robot.LEG_UPPER[number])),
            effort=str(robot.TORQUE_LIMIT),
            velocity=str(robot.NO_LOAD_SPEED),
        )
        ElementTree.SubElement(joint, 'dynamics', damping=str(robot.SERVO_DAMPING), friction='0.0')
    for part, length, radius, mass, colour in (
        ('coxa', robot.COXA_LENGTH, robot.COXA_RADIUS, robot.COXA_MASS, 'servo'),
        ('femur', robot.FEMUR_LENGTH, robot.FEMUR_RADIUS, robot.FEMUR_MASS, 'accent'),
    ):
        link = add_link(root, f'{leg}_{part}')
        across, along = capsule_inertia(mass, radius, length)
        inertia = np.diag([along, across, across])
        add_inertial(link, mass, (length / 2, 0.0, 0.0), inertia)
        add_capsule(link, (length, 0.0, 0.0), _ALONG_X, radius, colour)
    _add_tibia(root, leg)


def _add_tibia(root: ElementTree.Element, leg: str) -> None:
    """Add the tibia and the foot at its end, which is one body with it."""
    link = add_link(root, f'{leg}_tibia')
    tip = (0.0, 0.0, -robot.TIBIA_LENGTH)
    across, along = capsule_inertia(robot.TIBIA_MASS, robot.TIBIA_RADIUS, robot.TIBIA_LENGTH)
    ball = 0.4 * robot.FOOT_MASS * robot.FOOT_RADIUS**2
    mass = robot.TIBIA_MASS + robot.FOOT_MASS
    # Two bodies on one axis, half a tibia apart: Steiner's term is their reduced mass.
    reduced = robot.TIBIA_MASS * robot.FOOT_MASS / mass * (robot.TIBIA_LENGTH / 2) ** 2
    inertia = np.diag([across + ball + reduced, across + ball + reduced, along + ball])
    middle = -robot.TIBIA_LENGTH * (robot.TIBIA_MASS / 2 + robot.FOOT_MASS) / mass
    add_inertial(link, mass, (0.0, 0.0, middle), inertia)
    add_capsule(link, tip, ORIGIN, robot.TIBIA_RADIUS, 'servo')
    for kind in ('visual', 'collision'):
        radius = {'radius': str(robot.FOOT_RADIUS)}
        add_shape(link, 'sphere', radius, 'rubber', tip, kind=kind)


def capsule_inertia(mass: float, radius: float, length: float) -> tuple[float, float]:
    """Return the moments of inertia of a full capsule about its centre [kg m^2].

    A cylinder and two half balls of one density: a half ball's own centre is 3/8 of its radius
    from its flat side.

    Args:
        mass: of the whole [kg].
        radius: of its ends [m].
        length: between the centres of its ends [m].

    Returns:
        About an axis across it, and about its own axis.
    """
    ball_share = 4.0 * radius / (4.0 * radius + 3.0 * length)
    ball, cylinder = mass * ball_share, mass * (1.0 - ball_share)
    along = cylinder * radius**2 / 2 + ball * 0.4 * radius**2
    across = cylinder * (length**2 / 12 + radius**2 / 4)
    across += ball * (0.4 * radius**2 + length**2 / 4 + 0.375 * length * radius)
    return across, along


def add_link(root: ElementTree.Element, name: str) -> ElementTree.Element:
    """Add a link without anything yet."""
    return ElementTree.SubElement(root, 'link', name=name)


def add_joint(
    root: ElementTree.Element, name: str, kind: str, parent: str, child: str
) -> ElementTree.Element:
    """Add a joint of a kind between two links."""
    joint = ElementTree.SubElement(root, 'joint', name=name, type=kind)
    ElementTree.SubElement(joint, 'parent', link=parent)
    ElementTree.SubElement(joint, 'child', link=child)
    return joint


def add_inertial(
    link: ElementTree.Element, mass: float, centre: Vector, inertia: NDArray[np.float64]
) -> None:
    """Give a link its mass [kg], its centre of mass [m] and its inertia about it [kg m^2]."""
    inertial = ElementTree.SubElement(link, 'inertial')
    add_origin(inertial, centre, ORIGIN)
    ElementTree.SubElement(inertial, 'mass', value=str(mass))
    moments = {
        f'i{"xyz"[i]}{"xyz"[j]}': float(inertia[i, j]) for i in range(3) for j in range(i, 3)
    }
    ElementTree.SubElement(inertial, 'inertia', {key: str(m) for key, m in moments.items()})


def add_capsule(
    link: ElementTree.Element, end: Vector, angles: Vector, radius: float, colour: str
) -> None:
    """Add a capsule from the link's origin to another point."""
    middle = [x / 2 for x in end]
    shape = {'radius': str(radius), 'length': str(math.hypot(*end))}
    add_shape(link, 'cylinder', shape, colour, middle, angles)
    for centre in (ORIGIN, end):
        add_shape(link, 'sphere', {'radius': str(radius)}, colour, centre)


def add_shape(
    link: ElementTree.Element,
    shape: str,
    size: dict[str, str],
    colour: str,
    centre: Vector = ORIGIN,
    angles: Vector = ORIGIN,
    kind: str = 'visual',
) -> None:
    """Add a shape to what a link shows, or to what of it collides."""
    element = ElementTree.SubElement(link, kind)
    add_origin(element, centre, angles)
    ElementTree.SubElement(ElementTree.SubElement(element, 'geometry'), shape, size)
    if kind == 'visual':
        ElementTree.SubElement(element, 'material', name=colour)


def add_origin(element: ElementTree.Element, position: Vector, angles: Vector) -> None:
    """Put an element at a position [m], turned by roll, pitch and yaw [rad]."""
    ElementTree.SubElement(element, 'origin', xyz=numbers(position), rpy=numbers(angles))


def numbers(values: Vector) -> str:
    """Return numbers as an attribute holds them."""
    return ' '.join(str(float(value)) for value in values)


def main(arguments: Sequence[str] | None = None) -> None:
    """Write the URDF into a file."""
    parser = CommandLine(description=__doc__)
    parser.add_argument('file', type=file)
    path = parser.parse_args(arguments).file
    path.write_text(robot_description(), encoding='utf-8')


if __name__ == '__main__':
    main()
