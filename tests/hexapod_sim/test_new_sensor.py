# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A new sensor is one row of the table and one line of the model, and no other file knows it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from page_commands import ROOT, edited

PAGE = ROOT / 'docs' / 'tutorials' / 'my_sensor.md'
LOOK = """
import json
import numpy as np
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.nodes.messages import decode
from hexapod_agent.specification.run_spec import RunSpec
from interface_tables import sensor_table
from hexapod_doe.designs.factor import default_factors
from hexapod_doe.designs.factor_file import check_levels
from hexapod_doe.designs.factor import Factor
from hexapod_sim.fake_device import DEVICES
from hexapod_sim.nodes.messages import SENSOR_TOPICS

(factor,) = default_factors('H')
spec = RunSpec.load().with_value(factor.key, factor.high, 'a test')
env = HexapodLine(config=spec)
start, _ = env.reset(seed=1)
(topic,) = [topic for topic in SENSOR_TOPICS if topic.channel.letter == 'H']
message = topic.new()
topic.fill(message, env.task.sensors.read(topic.channel))
decoded = decode(topic.channel, {topic.name: message})
noise = check_levels(Factor('K', 'noise', 'sensors.magnetic_field.noise', 0, 0.1), spec)
noisy, _ = HexapodLine(config=spec.with_value(noise.key, noise.high, 'a test')).reset(seed=1)
print(json.dumps({
    'factor': [factor.name, factor.key, factor.device],
    'numbers': env.observation_spec.sizes['magnetic_field'],
    'observed': start[-3:].tolist(),
    'on topic': [topic.name, *decoded['magnetic_field']],
    'noisy': (noisy != start).tolist(),
    'drivers': list(DEVICES),
    'readme': [row for row in sensor_table().splitlines() if row.startswith('| H')],
}))
"""


@pytest.fixture
def found(tmp_path: Path) -> dict:
    """Return what a process finds that has the tutorial's row and line in its package."""
    edited(PAGE, 'hexapod_sim', tmp_path)
    support = ROOT / 'tests' / 'support'
    path = os.pathsep.join((str(tmp_path), str(support), os.environ.get('PYTHONPATH', '')))
    command = [sys.executable, '-c', LOOK]
    environment = os.environ | {'PYTHONPATH': path}
    told = subprocess.run(
        command, env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=60.0
    )
    assert told.returncode == 0, told.stderr
    return json.loads(told.stdout)


def test_one_row_and_one_line_make_a_channel_a_topic_a_factor_and_a_row(found: dict) -> None:
    assert found['factor'] == ['magnetic field', 'observations.H', 'magnetometer']
    assert found['numbers'] == 3
    # MuJoCo's field is 0.5 along -y of odom; the robot stands along x, all but level.
    assert found['observed'] == pytest.approx([0.0, -0.5, 0.0], abs=0.005)
    topic, *field = found['on topic']
    assert (topic, field) == ('magnetic_field', pytest.approx([0.0, -0.5, 0.0], abs=0.005))
    assert [index for index, differs in enumerate(found['noisy']) if differs] == [79, 80, 81]
    assert 'magnetic_field' in found['drivers']
    assert found['readme'] == [
        '| H | magnetic field | 3 | `magnetic_field` | `sensor_msgs/msg/MagneticField` | T | 1 '
        '| magnetometer |'
    ]
