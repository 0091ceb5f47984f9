# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Whether messages are what they should be: frame, joint names, lengths, finite numbers."""

from collections.abc import Iterator

import numpy as np
from hexapod_sim.channel import Field
from hexapod_sim.joint_names import joint_order
from hexapod_sim.robot import JOINTS

from hexapod_agent.contract.finding import Finding, Subject


def check_frame(subject: Subject) -> Iterator[Finding]:
    """Check the frame against the table's, or the one that the user says is equal."""
    channel, topic = subject.channel, subject.topic
    if not channel.frames:
        return
    wanted = subject.limits.frames.get(topic, channel.frames[channel.topics.index(topic)])
    for found in sorted({sample.frame for sample in subject.samples} - {wanted}):
        yield subject.finding(
            'wrong_frame',
            'header.frame_id',
            f"is '{found}'",
            f"'{wanted}'",
            f"let the driver report in {wanted}; where the axes of '{found}' are the same, say "
            f"so with frames '{topic}={found}'",
        )


def check_shape(subject: Subject) -> Iterator[Finding]:
    """Check joint names and lengths; one finding per field, and none on numbers after these."""
    joints = subject.channel.has_joints
    if joints:
        yield from _check_names(subject)
    for field in subject.channel.observed:
        for sample in subject.samples:
            size = len(sample.names) if joints else field.size
            if sample.values[field.path].size != size:
                yield _wrong_length(subject, field, sample.values[field.path].size, size)
                break


def check_finite(subject: Subject) -> Iterator[Finding]:
    """Check that every number is finite."""
    for field in subject.channel.observed:
        broken = ~np.isfinite(subject.stack(field.path))
        if not broken.any():
            continue
        # A number that never was finite is not a sample that failed: nothing measures it.
        never = broken.all(axis=0) if len(broken) > 1 else np.zeros(broken.shape[1], dtype=bool)
        index = int(np.flatnonzero(never if never.any() else broken.any(axis=0))[0])
        yield subject.finding(
            'not_finite',
            number_name(subject, field.path, index),
            f'is NaN or infinite in {broken[:, index].sum()} of {len(broken)} messages',
            'a finite number',
            _missing_cure(subject, field)
            if never.any()
            else 'let the driver leave out samples that it could not measure',
        )


def number_name(subject: Subject, path: str, index: int) -> str:
    """Return the name of one number of a field, such as 'position[lf_hip]'."""
    if subject.channel.has_joints:
        return f'{path}[{JOINTS[index]}]'
    return f'{path}[{index}]'


def _check_names(subject: Subject) -> Iterator[Finding]:
    for names in dict.fromkeys(sample.names for sample in subject.samples):
        try:
            joint_order(names)
        except ValueError as error:
            yield subject.finding(
                'wrong_names',
                'name',
                str(error).removeprefix('name ').partition(', expected')[0],
                f'{JOINTS[0]}, {JOINTS[1]}, … {JOINTS[-1]}, in any order',
                "name the driver's joints as the URDF does; one prefix for all of them is fine",
            )
            return


def _wrong_length(subject: Subject, field: Field, found: int, wanted: int) -> Finding:
    cure = f'let the driver fill all {wanted} numbers'
    if subject.channel.has_joints:
        cure = 'let the driver fill the field for every name'
        if not found:
            cure += f'; {_missing_cure(subject, field)}'
    return subject.finding(
        'wrong_length',
        field.path,
        f'has {found} numbers',
        f'{wanted}',
        cure,
    )


def _missing_cure(subject: Subject, field: Field) -> str:
    """Return what to do about a field that nothing measures."""
    if subject.channel.has_joints:
        return (
            f"let the hardware export the state interface '{field.path}' of every joint: "
            'joint_state_broadcaster fills in NaN, or nothing, where there is none; or start the '
            'driver that measures it'
        )
    return (
        'see whether the device measures it at all, and whether its driver is set up for it; '
        'or take a set without this channel'
    )
