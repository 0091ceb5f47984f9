# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The demo of the Makefile deletes nothing by itself, and analyses nothing unfinished."""

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.fixture
def make(tmp_path):
    """Return what runs a verb on a demo of its own, with the campaign's commands replaced.

    `python` (which is asked for the status) fails, and each command is noted.
    """
    (tmp_path / 'bin').mkdir()
    for name, status in (('python', 1), ('ros2', 0)):
        script = tmp_path / 'bin' / name
        script.write_text(f'#!/bin/sh\necho "{name} $*" >> {tmp_path}/noted\nexit {status}\n')
        script.chmod(0o755)

    def run(verb: str) -> subprocess.CompletedProcess[str]:
        words = ['make', '-o', 'setup', verb, f'DEMO={tmp_path}/demo', 'ENTER=:']
        environment = os.environ | {'PATH': f'{tmp_path}/bin:{os.environ["PATH"]}'}
        return subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, text=True)

    return run


def test_an_interrupted_demo_is_not_analysed(make, tmp_path):
    (tmp_path / 'demo').mkdir()
    (tmp_path / 'demo' / 'notes.txt').write_text('mine')
    ended = make('demo')  # its launch ends with status 0, as after Ctrl-C
    assert ended.returncode != 0
    assert '`make demo` goes on' in ended.stdout
    noted = (tmp_path / 'noted').read_text()
    assert 'ros2 launch hexapod_bringup campaign.launch.xml' in noted
    assert 'analyze' not in noted
    assert (tmp_path / 'demo' / 'notes.txt').exists()


def test_a_finished_demo_is_kept(make, tmp_path):
    (tmp_path / 'demo' / 'runs').mkdir(parents=True)
    (tmp_path / 'demo' / 'plan.csv').write_text('plan')
    (tmp_path / 'bin' / 'python').write_text('#!/bin/sh\nexit 0\n')
    ended = make('demo')
    assert ended.returncode == 0, ended.stderr
    assert '`make clean-demo` forgets it' in ended.stdout
    assert (tmp_path / 'demo' / 'runs').is_dir()
    noted = (tmp_path / 'noted').read_text()
    assert 'plan' not in noted.splitlines()[0].split()[2:3]
    assert 'analyze' in noted


def test_a_demo_is_forgotten_without_what_else_lies_there(make, tmp_path):
    demo = tmp_path / 'demo'
    (demo / 'runs').mkdir(parents=True)
    (demo / 'plan.csv').write_text('plan')
    (demo / 'notes.txt').write_text('mine')
    assert make('clean-demo').returncode == 0
    assert [path.name for path in demo.iterdir()] == ['notes.txt']
    (demo / 'notes.txt').unlink()
    assert make('clean-demo').returncode == 0
    assert not demo.exists()
