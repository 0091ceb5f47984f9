# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The robot as URDF, made of the numbers in robot.py, without meshes.

`python -m hexapod_bringup.description urdf/hexapod.urdf` writes the file that this package ships;
a test holds the file to this module, and both to the compiled MuJoCo model.

A capsule is a cylinder with a sphere at each end. What collides is what does in the simulation:
the body's box and the feet. `<leg>_foot` frames keep their axes along odom, so no link has them.
"""

import math
from collections.abc import Sequence
from xml.etree import ElementTree

import numpy as np
from hexapod_sim.command_line import CommandLine, file

from hexapod_bringup.urdf_elements import (
    ORIGIN,
    add_capsule,
    add_inertial,
    add_joint,
    add_link,
    add_origin,
    add_shape,
    numbers,
)
from hexapod_sim import robot

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
    note = '<!-- Written by hexapod_bringup.description; do not edit. -->'
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


def main(arguments: Sequence[str] | None = None) -> None:
    """Write the URDF into a file."""
    parser = CommandLine(description=__doc__)
    parser.add_argument('file', type=file)
    path = parser.parse_args(arguments).file
    path.write_text(robot_description(), encoding='utf-8')


if __name__ == '__main__':
    main()
