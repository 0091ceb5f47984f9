# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import pytest
from ros2_mini.launch.expand import parameter_value


@pytest.mark.parametrize(
    ('text', 'type_name', 'expected'),
    [
        ('1', 'yaml', 1),
        ('1.0', 'yaml', 1.0),
        ('true', 'yaml', True),
        ('hello', 'yaml', 'hello'),
        ('', 'yaml', ''),
        ('[1.0, 2.0]', 'yaml', [1.0, 2.0]),
        ("['a', 'b']", 'yaml', ['a', 'b']),
        ('007', 'yaml', 7),  # YAML 1.1: why a run's name wants type="str"
        ('007', 'str', '007'),
        ('[a', 'str', '[a'),
    ],
)
def test_value(text, type_name, expected):
    found = parameter_value(text, type_name)
    assert found == expected
    assert type(found) is type(expected)


@pytest.mark.parametrize(
    ('text', 'type_name', 'message'),
    [
        ('{a: 1}', 'yaml', 'no bool, int, float, str or list of these'),
        ('null', 'yaml', 'no bool, int'),
        ('[]', 'yaml', 'no list of one type'),
        ('[1, 2.0]', 'yaml', 'no list of one type'),
        ('[a', 'yaml', r'no YAML; give a text with type="str"'),
        ('[1]', 'list_of_int', 'expected yaml, str'),
    ],
)
def test_error(text, type_name, message):
    with pytest.raises(ValueError, match=message):
        parameter_value(text, type_name)
