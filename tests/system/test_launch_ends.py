# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The nodes of a launch end with it, however it ends; a worker that loads ends without a trace."""

from __future__ import annotations

import signal
import subprocess
import time
from pathlib import Path
from xml.etree import ElementTree

import pytest
from ament_index_python.packages import get_package_share_directory
from rclpy.node import Node

pytestmark = pytest.mark.system
LAUNCHES = sorted(Path(get_package_share_directory('hexapod_bringup'), 'launch').iterdir())


def children(pid: int) -> list[int]:
    """Return the processes that a process has started."""
    return list(map(int, Path(f'/proc/{pid}/task/{pid}/children').read_text().split()))


def gone(pid: int) -> bool:
    """Whether a process is no more, or only waits to be reaped."""
    status = Path(f'/proc/{pid}/stat')
    try:
        return status.read_text().rpartition(')')[2].split()[0] == 'Z'
    except OSError:
        return True


def test_nodes_end_when_their_launch_is_killed(shell, observer: Node) -> None:
    launch = shell.start('ros2 launch hexapod_bringup description.launch.xml')
    shell.until(lambda: 'process started' in shell.output())
    (node,) = children(launch.pid)
    shell.until(lambda: 'description' in observer.get_node_names())
    launch.send_signal(signal.SIGKILL)
    shell.until(lambda: gone(node), timeout_s=10.0)


@pytest.mark.parametrize('file', LAUNCHES, ids=lambda file: file.name)
def test_every_launch_file_tells_its_nodes_first(file: Path) -> None:
    tags = [element for element in ElementTree.parse(file).getroot() if element.tag != 'arg']
    assert tags[0].tag == 'set_env'
    assert tags[0].attrib == {'name': 'HEXAPOD_LAUNCHED', 'value': '1'}


def test_a_worker_that_is_interrupted_while_it_loads_ends_in_order(shell) -> None:
    worker = subprocess.Popen(
        ['ros2', 'run', 'hexapod_bringup', 'worker_node'],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        cwd=shell.directory,
    )
    loaded = Path(f'/proc/{worker.pid}/maps')
    shell.until(lambda: '_rclpy_pybind11' in loaded.read_text())  # rclpy is there, torch is not
    time.sleep(0.3)
    worker.send_signal(signal.SIGINT)
    output, _ = worker.communicate(timeout=60.0)
    assert worker.returncode == 0, output
    assert 'Traceback' not in output
