# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Every node starts with `ros2 run`, takes the usual arguments and ends well on a signal."""

from __future__ import annotations

import signal

import pytest
from rclpy.node import Node

pytestmark = pytest.mark.system

NODES = {
    'sim': 'hexapod_sim sim_node',
    'cpg': 'hexapod_cpg cpg_node',
    'agent': 'hexapod_agent agent_node',
    'recorder': 'hexapod_doe recorder_node',
}


@pytest.mark.parametrize('how', [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize('name', NODES)
def test_a_signal_ends_a_node_with_status_0(
    shell, observer: Node, name: str, how: signal.Signals
) -> None:
    process = shell.start(f'ros2 run {NODES[name]} --ros-args -r __ns:=/robot')
    shell.until(lambda: name in observer.get_node_names())
    process.send_signal(how)
    assert process.wait(10.0) == 0, shell.output()
    assert 'Traceback' not in shell.output()


def test_parameters_files_and_remappings_are_taken(shell, observer: Node) -> None:
    (shell.directory / 'p.yaml').write_text(
        '/**/cpg:\n  ros__parameters:\n    cpg.gait: wave\n    cpg.alpha: 30.0\n'
    )
    shell.start(
        'ros2 run hexapod_cpg cpg_node --ros-args -r __ns:=/robot --params-file p.yaml '
        '-p cpg.alpha:=40.0 -r joint_trajectory:=/legs/joint_trajectory'
    )
    shell.until(lambda: '/legs/joint_trajectory' in dict(observer.get_topic_names_and_types()))
    assert 'wave' in shell.run('ros2 param get /robot/cpg cpg.gait').stdout
    assert '40.0' in shell.run('ros2 param get /robot/cpg cpg.alpha').stdout


@pytest.mark.parametrize(
    ('line', 'complaint'),
    [
        ('hexapod_agent agent_node --ros-args -p timeout:=-1.0', 'timeout'),
        ('hexapod_cpg cpg_node --ros-args -p cpg.gait:=gallop', "gait 'gallop': expected one of"),
        (
            'hexapod_doe manager_node --ros-args -p plan:=/no/plan.csv',
            "plan '/no/plan.csv': no such file",
        ),
    ],
)
def test_a_bad_parameter_is_one_clear_line(shell, line: str, complaint: str) -> None:
    ended = shell.run(f'ros2 run {line}')
    assert ended.returncode == 1
    assert complaint in ended.stderr
    assert 'Traceback' not in ended.stderr


@pytest.mark.parametrize('composed', ['true', 'false'])
def test_a_worker_launches_in_one_process_or_in_four(shell, observer: Node, composed: str) -> None:
    launch = shell.start(
        f'ros2 launch hexapod_bringup worker.launch.xml namespace:=w composed:={composed}'
    )
    expected = {(name, '/w') for name in NODES}
    shell.until(lambda: expected <= set(observer.get_node_names_and_namespaces()))
    assert '/w/train_run' in shell.run('ros2 node info /w/agent').stdout
    launch.send_signal(signal.SIGINT)
    assert launch.wait(15.0) == 0, shell.output()
