# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The shipped URDF with a load, dead legs and missing legs, as the simulation shows them."""

from xml.etree import ElementTree

from hexapod_sim.robot import BASE_FRAME, LEGS
from hexapod_sim.variations import dead_legs, payload
from hexapod_sim.variations.dead_legs import DeadLegs
from hexapod_sim.variations.missing_legs import MissingLegs
from hexapod_sim.variations.table import RobotConfig

_BULK = ('inertial', 'visual', 'collision')


def description_of(urdf: str, robot: RobotConfig) -> str:
    """Return the description of a varied robot.

    Frames and joints stay, so that states of all 18 joints fit. Weak motors and blocked joints
    show by how they move, and `fault_time` is past.

    Args:
        urdf: Description of the robot as it was built.
        robot: How it differs.
    """
    if robot == robot.undamaged:
        return urdf
    root = ElementTree.fromstring(urdf)
    if robot.payload:
        _add_payload(root, robot)
    missing = MissingLegs(robot).legs
    for link in root.iter('link'):
        leg = link.get('name', '').split('_')[0]
        if leg in LEGS and leg in missing:
            _remove_bulk(link)
        elif leg in LEGS and leg in DeadLegs(robot).legs:
            _paint(link)
    ElementTree.indent(root)
    text = ElementTree.tostring(root, encoding='unicode')
    return f'<?xml version="1.0"?>\n{text}\n'


def _add_payload(root: ElementTree.Element, robot: RobotConfig) -> None:
    """Fix a cube to the body; a cube of mass m and edge e has the inertia m e² / 6."""
    link = ElementTree.SubElement(root, 'link', name='payload')
    inertial = ElementTree.SubElement(link, 'inertial')
    ElementTree.SubElement(inertial, 'mass', value=str(robot.payload))
    moment = str(robot.payload * robot.payload_edge**2 / 6)
    moments = dict.fromkeys(('ixx', 'iyy', 'izz'), moment)
    ElementTree.SubElement(
        inertial, 'inertia', moments | dict.fromkeys(('ixy', 'ixz', 'iyz'), '0.0')
    )
    visual = ElementTree.SubElement(link, 'visual')
    geometry = ElementTree.SubElement(visual, 'geometry')
    ElementTree.SubElement(geometry, 'box', size=_words([robot.payload_edge] * 3))
    _colour(visual, 'payload', payload.COLOUR)
    joint = ElementTree.SubElement(root, 'joint', name='payload_mount', type='fixed')
    ElementTree.SubElement(joint, 'parent', link=BASE_FRAME)
    ElementTree.SubElement(joint, 'child', link='payload')
    place = [robot.payload_x, robot.payload_y, robot.payload_z]
    ElementTree.SubElement(joint, 'origin', xyz=_words(place), rpy='0.0 0.0 0.0')


def _remove_bulk(link: ElementTree.Element) -> None:
    """Leave the frame of a link alone."""
    for part in [child for child in link if child.tag in _BULK]:
        link.remove(part)


def _paint(link: ElementTree.Element) -> None:
    for visual in link.findall('visual'):
        for material in visual.findall('material'):
            visual.remove(material)
        _colour(visual, 'dead', dead_legs.COLOUR)


def _colour(visual: ElementTree.Element, name: str, colour: tuple[float, ...]) -> None:
    material = ElementTree.SubElement(visual, 'material', name=name)
    ElementTree.SubElement(material, 'color', rgba=_words(colour))


def _words(numbers: list[float] | tuple[float, ...]) -> str:
    return ' '.join(str(number) for number in numbers)
