# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import importlib
import subprocess
import sys
from pathlib import Path

import pytest
from ros2_mini.cli import COMMANDS, VERBS, main

SAMPLE = Path(__file__).resolve().parents[2] / 'bags' / 'sample'
PATHS = [(command,) for command in COMMANDS] + [
    (command, verb) for command, verbs in VERBS.items() for verb in verbs
]


@pytest.mark.parametrize('path', PATHS, ids=' '.join)
def test_every_verb_has_help(path, capsys):
    with pytest.raises(SystemExit) as caught:
        main([*path, '--help'])
    assert caught.value.code == 0
    assert f'usage: ros2 {" ".join(path)}' in capsys.readouterr().out
    module = importlib.import_module(f'ros2_mini.verbs.{path[0]}')
    assert module.__doc__.startswith(f'`ros2 {path[0]}`: ')
    assert list(module.VERBS) == list(VERBS.get(path[0], ['']))


@pytest.mark.parametrize('words', [[], ['topic']])
def test_command_without_verb_shows_what_there_is(words, capsys):
    assert main(words) == 0
    assert 'Call `ros2 ' in capsys.readouterr().out


@pytest.mark.parametrize('words', [['nope'], ['topic', 'nope'], ['topic', 'echo']])
def test_wrong_usage_exits_with_2(words, capsys):
    with pytest.raises(SystemExit) as caught:
        main(words)
    assert caught.value.code == 2
    assert 'usage: ros2' in capsys.readouterr().err


@pytest.mark.parametrize(
    'words',
    [
        ['lifecycle', 'set', 'a', 'b', '--no-such'],
        ['pkg', 'prefix', 'demo', '--spin-time', '1'],
    ],
)
def test_options_that_the_original_lacks_are_refused(words, capsys):
    with pytest.raises(SystemExit) as caught:
        main(words)
    assert caught.value.code == 2
    assert 'unrecognized arguments' in capsys.readouterr().err


def test_packages_are_found_without_waiting_for_rclpy():
    words = "['pkg', 'prefix', 'hexapod_cpg']"
    code = f"import sys, ros2_mini.cli as c; c.main({words}); print('rclpy' in sys.modules)"
    done = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, check=True)
    lines = done.stdout.splitlines()
    assert lines[0].endswith('hexapod_cpg')
    assert lines[1:] == ['False']


def test_reader_that_leaves_early_is_no_error():
    command = (
        f'{sys.executable} -m ros2_mini bag info {SAMPLE} | head -n 1; exit ${{PIPESTATUS[0]}}'
    )
    done = subprocess.run(['bash', '-c', command], capture_output=True, text=True, check=False)
    assert done.stdout.count('\n') == 1
    assert done.stderr == ''
