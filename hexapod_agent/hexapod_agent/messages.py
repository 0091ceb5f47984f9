# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Messages of the sensor topics as the readings that an observation is made of."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

import numpy as np
from geometry_msgs.msg import TwistStamped, Vector3, WrenchStamped
from hexapod_interfaces.msg import CpgState, FootContacts, LineOffset, StepOutcome
from hexapod_sim.joint_names import by_joint
from hexapod_sim.robot import LEGS
from hexapod_sim.sensors import foot_forces
from hexapod_sim.task import Outcome
from numpy.typing import NDArray
from sensor_msgs.msg import Imu, JointState, Range

from hexapod_agent.observation import Channel

Reading = NDArray[np.float64]
Readings = dict[str, Reading]


def message_class(name: str) -> type:
    """Return the class of a message type such as `sensor_msgs/msg/Imu`."""
    package, _, kind = name.split('/')
    return getattr(import_module(f'{package}.msg'), kind)


def decode(channel: Channel, messages: Mapping[str, Any]) -> Readings:
    """Return what a channel reads from the messages of its topics.

    Joint arrays are matched by joint name: a driver may publish them in its own order, with
    further joints, and with a prefix before the names.

    Raises:
        ValueError: a joint is missing or an array is too short; the text names topic and field.
    """
    return _DECODERS[channel.topics[0]](messages)


def outcome_from_message(message: StepOutcome) -> Outcome:
    """Return what a control period earned."""
    return Outcome(
        step=message.step,
        reward=message.reward,
        terms=dict(zip(message.term_names, message.term_values, strict=True)),
        terminated=message.terminated,
        truncated=message.truncated,
        cause=message.cause,
    )


def _joint_states(messages: Mapping[str, JointState]) -> Readings:
    message = messages['joint_states']
    return {
        'joint_angles': _by_joint('joint_states', message, 'position'),
        'joint_velocities': _by_joint('joint_states', message, 'velocity'),
    }


def _joint_torques(messages: Mapping[str, JointState]) -> Readings:
    message = messages['joint_torques']
    return {'joint_torques': _by_joint('joint_torques', message, 'effort')}


def _by_joint(topic: str, message: JointState, field: str) -> Reading:
    try:
        return by_joint(message.name, getattr(message, field), field)
    except ValueError as error:
        raise ValueError(f'{topic}: {error}') from error


def _cpg_state(messages: Mapping[str, CpgState]) -> Readings:
    message = messages['cpg/state']
    return {'oscillator': np.concatenate([message.x, message.y])}


def _line_offset(messages: Mapping[str, LineOffset]) -> Readings:
    return {'line_offset': np.array([messages['line_offset'].offset])}


def _twist(messages: Mapping[str, TwistStamped]) -> Readings:
    return {'linear_velocity': _vector(messages['body/twist'].twist.linear)}


def _imu(messages: Mapping[str, Imu]) -> Readings:
    q = messages['imu/data'].orientation
    return {'orientation': np.array([q.x, q.y, q.z, q.w])}


def _imu_raw(messages: Mapping[str, Imu]) -> Readings:
    return {'angular_velocity': _vector(messages['imu/data_raw'].angular_velocity)}


def _height(messages: Mapping[str, Range]) -> Readings:
    return {'height': np.array([messages['body/height'].range])}


def _foot_forces(messages: Mapping[str, WrenchStamped]) -> Readings:
    forces = [_vector(messages[f'foot_force/{leg}'].wrench.force) for leg in LEGS]
    return {'foot_forces': foot_forces(np.array(forces))}


def _foot_contacts(messages: Mapping[str, FootContacts]) -> Readings:
    return {'foot_contacts': np.array(messages['foot_contacts'].contact, dtype=np.float64)}


def _vector(vector: Vector3) -> Reading:
    return np.array([vector.x, vector.y, vector.z])


_DECODERS: Mapping[str, Callable[[Mapping[str, Any]], Readings]] = {
    'joint_states': _joint_states,
    'cpg/state': _cpg_state,
    'line_offset': _line_offset,
    'joint_torques': _joint_torques,
    'body/twist': _twist,
    'imu/data': _imu,
    'imu/data_raw': _imu_raw,
    'body/height': _height,
    f'foot_force/{LEGS[0]}': _foot_forces,
    'foot_contacts': _foot_contacts,
}
