# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The table of a sensor check says each topic's verdict, and each fault with its cure."""

from __future__ import annotations

from io import StringIO

from hexapod_agent.contract.finding import Finding
from hexapod_agent.contract.report import SensorReport, TopicRow
from hexapod_doe.nodes.check_sensors_node import show
from rich.console import Console

FAULT = Finding(
    'wrong_frame', 'body height', '/tof', 'header.frame_id', "is 'x'", "'height_link'", 'turn it'
)
ROW = TopicRow(
    'E', 'body height', '/tof', 'sensor_msgs/msg/Range', 80, 39.96, 0.0021, 'x', 'fault'
)


def printed(report: SensorReport) -> str:
    out = StringIO()
    show(report, Console(file=out, width=80, highlight=False))
    return out.getvalue()


def test_a_fault_is_printed_with_field_and_cure() -> None:
    text = printed(SensorReport('E', (ROW,), (FAULT,)))
    rows = [line.split() for line in text.splitlines()]
    assert ['E', 'body', 'height', '/tof', '40.0', '2.1', 'x', 'fault'] in rows
    assert "fault /tof: header.frame_id is 'x'" in text
    assert "expected 'height_link'" in text
    assert 'cure: turn it' in text
    assert text.rstrip().endswith('Sensors of E: 1 fault')


def test_a_pass_is_one_line_after_the_table() -> None:
    silent = TopicRow('', 'x', '/x', '', 0, None, None, '', 'pass')
    text = printed(SensorReport('', (silent,), ()))
    assert text.rstrip().endswith('Sensors: pass')
    assert 'fault' not in text
