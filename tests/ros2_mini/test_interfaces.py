# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import pytest
from ros2_mini.errors import CommandError
from ros2_mini.interfaces import load_type
from std_msgs.msg import String


def test_types_by_long_and_short_name():
    assert load_type('std_msgs/msg/String', 'msg') is String
    assert load_type('std_msgs/String', 'msg') is String


@pytest.mark.parametrize(
    ('name', 'kind', 'message'),
    [
        ('std_msgs/msg/Strin', 'msg', "message type is invalid: 'std_msgs/msg/Strin' is not inst"),
        ('no_msgs/msg/String', 'msg', 'is not installed'),
        ('std_msgs/msg/String', 'srv', 'service type is invalid: .*expected <package>/srv/<name>'),
        ('String', 'srv', 'service type is invalid'),
    ],
)
def test_missing_type_is_named(name, kind, message):
    with pytest.raises(CommandError, match=message):
        load_type(name, kind)
