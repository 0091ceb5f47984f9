# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Elements of a URDF, one function each."""

import math
from collections.abc import Sequence
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

Vector = Sequence[float] | NDArray[np.float64]
ORIGIN = (0.0, 0.0, 0.0)


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
