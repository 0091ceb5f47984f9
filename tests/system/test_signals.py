# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A terminal and `ros2 launch` both send SIGINT: two of them end any node as one does."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from rclpy.node import Node

pytestmark = pytest.mark.system
ROOT = Path(__file__).resolve().parents[2]
SAMPLE = ROOT / 'bags' / 'sample'
AGENT = ROOT / 'ros_ws' / 'src' / 'hexapod_bringup' / 'agents' / 'ABCDE.pt'
BETWEEN_S = 0.05
DOE = 'ros2 run hexapod_doe'
AGENTS = 'ros2 run hexapod_agent'

# What starts each node, and the node that is there once it is up.
LINES = {
    'sim': ('ros2 run hexapod_sim sim_node', 'sim'),
    'cpg': ('ros2 run hexapod_cpg cpg_node', 'cpg'),
    'agent': (f'{AGENTS} agent_node', 'agent'),
    'recorder': (f'{DOE} recorder_node', 'recorder'),
    'worker': ('ros2 run hexapod_bringup worker_node', 'agent'),
    'manager': (f'{DOE} manager_node --ros-args -p plan:=c/plan.csv -p local_workers:=1', 'agent'),
    'player': (f'{DOE} player_node --ros-args -p bag:={SAMPLE} -p paused:=true', 'player'),
    'play': (f'{AGENTS} play_node --ros-args -p checkpoint:={AGENT}', 'play'),
    'play in real time': (
        f'{AGENTS} play_node --ros-args -p checkpoint:={AGENT} -p sync:=realtime',
        'play',
    ),
    'evaluate': (f'{AGENTS} evaluate {AGENT} --graph --starts 40', 'evaluation'),
    'shadow': (f'{DOE} shadow {SAMPLE} --checkpoint {AGENT} --graph', 'shadow'),
    'fake driver': ('ros2 run hexapod_sim fake_driver', 'fake_driver'),
    'description': ('ros2 run hexapod_bringup description_node', 'description'),
    'check_sensors': (f'{DOE} check_sensors --observations A --seconds 60', 'check_sensors'),
}
# A row that was interrupted is not done, as a batch system has to know: docs/tutorials/batch.md.
CASE = f'{DOE} run_case --plan c/plan.csv --row 1 --episodes 50 --out jobs'
QUICK = ('worker', 'manager', 'evaluate', 'play in real time')


@pytest.fixture
def plan(shell) -> None:
    made = shell.call(f'{DOE} plan --generators B=A --factors 2 --seed 3 --out c/plan.csv')
    assert made.returncode == 0, made.stderr


def end(process: subprocess.Popen[str], shell, *expected: int) -> None:
    """Send two SIGINT and look how it ends."""
    process.send_signal(signal.SIGINT)
    time.sleep(BETWEEN_S)
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
    assert process.wait(30.0) in (expected or (0,)), shell.output()
    assert 'Traceback' not in shell.output()
    assert 'KeyboardInterrupt' not in shell.output()


@pytest.mark.parametrize(
    'name', [pytest.param(n, marks=[] if n in QUICK else pytest.mark.slow) for n in LINES]
)
def test_two_interrupts_end_a_node_with_status_0(shell, plan, observer: Node, name: str) -> None:
    line, node = LINES[name]
    process = shell.start(line)
    shell.until(lambda: node in observer.get_node_names(), 60.0)
    # `shadow` may have ended by itself, with 1, as the bag is of another agent.
    end(process, shell, *((0, 1) if name == 'shadow' else (0,)))
    shell.until(lambda: node not in observer.get_node_names(), 60.0)


@pytest.mark.slow
def test_two_interrupts_end_a_row_as_interrupted(shell, plan) -> None:
    process = shell.start(CASE)
    shell.until(lambda: (shell.directory / 'jobs').is_dir(), 60.0)
    shell.until(lambda: any((shell.directory / 'jobs' / 'runs').glob('*.partial')), 60.0)
    end(process, shell, 1)
    assert 'the same command goes on' in shell.output()


@pytest.mark.slow
@pytest.mark.parametrize('wait_s', [0.2, 0.5, 1.0, 2.0, 3.0])
@pytest.mark.parametrize('how', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_amid_a_run_ends_a_worker_with_status_0(
    shell, plan, observer: Node, wait_s: float, how: signal.Signals
) -> None:
    line = 'ros2 run hexapod_bringup worker_node --ros-args -p root:=c'
    worker = shell.start(line)
    manager = shell.start(
        f'{DOE} manager_node --ros-args -p plan:=c/plan.csv -p local_workers:=0 -p episodes:=50'
    )
    shell.until(lambda: any((shell.directory / 'c' / 'runs').glob('*.partial')), 60.0)
    time.sleep(wait_s)
    worker.send_signal(how)
    assert worker.wait(30.0) == 0, shell.output()
    end(manager, shell)


EARLY = """
import os, signal, sys, threading
from hexapod_node.executable import executable
main = executable('{module}')
sys.argv = ['early']
threading.Timer({after}, os.kill, (os.getpid(), {number})).start()
main()
"""


@pytest.mark.parametrize('how', [signal.SIGTERM, signal.SIGINT])
@pytest.mark.parametrize(
    'after',
    [
        0.05,
        0.4,
        pytest.param(0.8, marks=pytest.mark.slow),
        pytest.param(1.5, marks=pytest.mark.slow),
    ],
)
def test_a_signal_while_libraries_are_loaded_ends_a_node_with_status_0(
    after: float, how: signal.Signals
) -> None:
    program = EARLY.format(module='hexapod_agent.nodes.agent_node', after=after, number=int(how))
    ended = subprocess.run(
        [sys.executable, '-c', program], capture_output=True, text=True, timeout=60, check=False
    )
    assert ended.returncode == 0, ended.stderr
    assert 'Traceback' not in ended.stderr


IN_A_FINALISER = """
import os, signal, time
from hexapod_node import signals
class Dying:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGTERM)
signals.end_at_once()
Dying()
time.sleep(30.0)
"""


def test_a_signal_within_a_finaliser_is_not_lost_while_libraries_are_loaded() -> None:
    ended = subprocess.run(
        [sys.executable, '-c', IN_A_FINALISER], capture_output=True, timeout=20, check=False
    )
    assert (ended.returncode, ended.stderr) == (0, b'')
