# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How many participants a host has, and what the later ones of too many find."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from hexapod_node.participants import REACHED, participants_here, warn_if_late

# What proc(5) lists: local address and port in hexadecimal in the second column.
HEAD = '  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid\n'
ROW = '{n:4d}: 0100007F:{port:04X} 00000000:0000 07 00000000:00000000 00:00000000 00000000 0\n'
# Contexts of one process, each a participant, print how many of all nodes each one knows.
CONTEXTS = """
import os, sys, time, rclpy
from rclpy.context import Context
nodes = []
for number in range(int(sys.argv[1])):
    context = Context()
    rclpy.init(args=[], context=context)
    options = dict(start_parameter_services=False, enable_rosout=False)
    nodes.append(rclpy.create_node(f'n{number}', context=context, **options))
time.sleep(8.0)
print(*(len(node.get_node_names()) for node in nodes), flush=True)
os._exit(0)
"""


def test_the_ports_of_a_domain_are_counted(tmp_path: Path) -> None:
    first = 7400 + 250 * 2 + 10
    ports = [first, first + 2, first + 2, first + 238, first + 1, first + 240, first - 10, 53]
    rows = [ROW.format(n=n, port=port) for n, port in enumerate(ports)]
    (tmp_path / 'udp').write_text(HEAD + ''.join(rows))
    assert participants_here(2, tmp_path / 'udp') == 3
    assert participants_here(2, tmp_path / 'nowhere') == 0


@pytest.mark.parametrize(('others', 'scope', 'lines'), [
    (31, 'LOCALHOST', 0), (32, 'LOCALHOST', 1), (32, 'SUBNET', 0), (32, 'OFF', 0),
])  # fmt: skip
def test_the_thirty_third_is_told(monkeypatch, capsys, others, scope, lines) -> None:
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', scope)
    warn_if_late(others)
    told = capsys.readouterr().err.splitlines()
    assert len(told) == lines
    assert all('participant 33 of ROS domain' in line for line in told)


@pytest.mark.slow
def test_the_first_32_know_all_and_later_ones_know_them() -> None:
    count = REACHED + 3
    ended = subprocess.run(
        [sys.executable, '-c', CONTEXTS, str(count)], capture_output=True, text=True, check=True
    )
    known = [int(word) for word in ended.stdout.split()]
    assert known == [count] * REACHED + [REACHED + 1] * 3
