# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A fake device has its own names, and settings that do not suit its channel are refused."""

from __future__ import annotations

import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from hexapod_sim.fake_device import FakeDevice
from hexapod_sim.nodes.fake_driver_node import PARAMETERS
from hexapod_sim.robot import LEGS

DEFAULTS = {entry.name: entry.default for entry in PARAMETERS}


def device(**settings: object) -> FakeDevice:
    return FakeDevice(DEFAULTS | settings)


def test_topics_and_frames_are_its_own_for_each_leg() -> None:
    cells = device(channel='foot_force', topic='cells/force', frame='cell')
    assert cells.topics == tuple(f'foot_force/{leg}' for leg in LEGS)
    message = WrenchStamped()
    cells.degrade(message, 'foot_force/rm', 0, '')
    assert cells.own_topic('foot_force/rm') == 'cells/force/rm'
    assert message.header.frame_id == 'cell_rm'


def test_without_names_of_its_own_the_topic_says_driver() -> None:
    assert device(channel='imu/data').own_topic('imu/data') == 'driver/imu/data'


def test_six_cells_have_six_errors() -> None:
    cells = device(channel='foot_force', bias=1.0)
    forces = []
    for topic in cells.topics:
        message = WrenchStamped()
        cells.degrade(message, topic, 0, '')
        forces.append(message.wrench.force.x)
    assert len(set(forces)) == 6
    assert not np.isclose(forces, 0.0).any()


@pytest.mark.parametrize(
    ('settings', 'complaint'),
    [
        ({'fault': 'wrong_length'}, "fault 'wrong_length': imu/data cannot have it.*stopped"),
        ({'velocity_noise': 0.1}, r'velocity_\*: expected channel joint_states, not imu/data'),
        ({'joint_prefix': 'px/'}, r'joint_\*: expected a channel with joints, not imu/data'),
        (
            {'channel': 'joint_states', 'extra_joints': 2},
            'extra_joints 2: expected joint_order shuffled',
        ),
        ({'noise': -1.0}, 'noise -1.0: expected'),
    ],
)
def test_what_does_not_suit_the_channel_is_refused(settings: dict, complaint: str) -> None:
    with pytest.raises(ValueError, match=complaint):
        device(**settings)
