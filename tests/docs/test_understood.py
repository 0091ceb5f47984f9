# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A page that asks for what a program no longer has is found, whatever it asks for."""

from pathlib import Path

import pytest
import understood
from page_commands import ROOT, Block, commands, typed
from small_sizes import small


@pytest.mark.parametrize(
    'line',
    [
        'ros2 run hexapod_agent train --gone 1 --out runs/a',
        'ros2 run hexapod_agent train --out runs/a --set task.gone=1',
        'ros2 run hexapod_agent evaluate a.pt --grid scene.gone=1,2',
        'ros2 run hexapod_agent gone',
        'ros2 run hexapod_doe plan hours --hours 8 --gone',
        'ros2 run hexapod_doe check_sensors --observations ABCDE --gone',
        'ros2 run hexapod_doe player_node --ros-args -p gone:=1',
        'ros2 run hexapod_doe player_node --gone',
        'ros2 launch hexapod_bringup campaign.launch.xml gone:=1',
        'ros2 launch hexapod_bringup gone.launch.xml',
        'ros2 run hexapod_bringup watch --gone',
        'ros2 topic gone',
        'ros2 bag info --gone bags/sample',
        'make gone',
        'python -m hexapod_doe.studies.learning --gone --out runs/a',
        'python examples/read_bag.py --gone',
        'python examples/gone.py',
    ],
)
def test_what_is_gone_is_found(line: str) -> None:
    with pytest.raises(understood.NotUnderstoodError):
        understood.check(line.split())


@pytest.mark.parametrize(
    'line',
    [
        'ros2 run hexapod_agent train --observations ABCDE --episodes 3 --out runs/a',
        'ros2 run hexapod_doe player_node --ros-args -p bag:=bags/sample -p rate:=0',
        'ros2 launch hexapod_bringup campaign.launch.xml plan:=plan.csv episodes:=3',
        'make demo',
    ],
)
def test_what_is_there_is_taken(line: str) -> None:
    understood.check(line.split())


def test_a_shell_makes_the_words(tmp_path: Path) -> None:
    text = 'for n in 1 2; do\n  ros2 run x "a b" $n   # said\ndone\n'
    block = Block(ROOT / 'README.md', 1, 'bash', text, 'quick')
    assert commands(block, tmp_path) == [['ros2', 'run', 'x', 'a b', n] for n in '12']


@pytest.mark.parametrize('text', ['ros2 "run', 'unheard_of --option\n'])
def test_what_no_shell_runs_is_found(text: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r'README\.md:1'):
        commands(Block(ROOT / 'README.md', 1, 'bash', text, 'quick'), tmp_path)


def test_of_a_session_what_is_typed_is_read() -> None:
    assert typed('$ make demo\nprinted\n$ make test\n') == 'make demo\nmake test\n'
    assert typed('make demo\n') == 'make demo\n'


def test_sizes_become_small_and_nothing_else_changes() -> None:
    line = ['ros2', 'run', 'hexapod_doe', 'plan', '--design', 'quarter', '--replicates', '10']
    plan = small([*line, '--seed', '1'])
    assert plan[4:10] == ['--design', 'eighth', '--replicates', '2', '--seed', '1']
    hours = ['ros2', 'run', 'hexapod_doe', 'plan', 'hours', '--hours', '8', '--episodes', '300']
    assert small(hours) == hours
