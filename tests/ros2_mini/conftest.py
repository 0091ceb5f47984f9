# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A made-up package to run and launch from, and the command line as a process of its own."""

import os
import stat
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from ros2_mini.cli import main

HERE = Path(__file__).resolve().parent
ROS2 = HERE.parents[1] / 'ros_ws' / 'src' / 'ros2_mini' / 'bin' / 'ros2'


def end(process: subprocess.Popen[str]) -> None:
    """End a process, gently if it can: one that is killed leaves its shared memory behind."""
    process.terminate()
    try:
        process.wait(timeout=10)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    process.stdout.close()


class Prefix:
    """An install prefix with the package `demo`."""

    def __init__(self, root: Path):
        self.root = root
        self.share = root / 'share' / 'demo'
        self._lib = root / 'lib' / 'demo'
        index = root / 'share' / 'ament_index' / 'resource_index' / 'packages'
        for folder in (self.share, self._lib, index):
            folder.mkdir(parents=True)
        (index / 'demo').touch()

    def add_executable(self, name: str, script: str) -> Path:
        """Install a shell script as an executable of the package."""
        path = self._lib / name
        path.write_text(f'#!/bin/sh\n{script}\n')
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return path

    def add_launch_file(self, body: str, name: str = 'demo.launch.xml') -> Path:
        """Install a launch file, given what its root holds."""
        path = self.share / name
        path.write_text(f'<launch>\n{body}\n</launch>\n')
        return path


@pytest.fixture
def prefix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Prefix:
    """The package `demo`, in front of what is installed, for this process and its children."""
    made = Prefix(tmp_path / 'prefix')
    path = os.pathsep.join([str(made.root), os.environ.get('AMENT_PREFIX_PATH', '')])
    monkeypatch.setenv('AMENT_PREFIX_PATH', path)
    return made


@pytest.fixture
def start() -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Start `ros2` as a process, and see that it ends with the test."""
    started: list[subprocess.Popen[str]] = []

    def start_ros2(*words: str) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [str(ROS2), *words],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            text=True,
        )
        started.append(process)
        return process

    yield start_ros2
    for process in started:
        end(process)


@pytest.fixture(scope='module')
def sample() -> Iterator[subprocess.Popen[str]]:
    """The sample node, as a process, once it is up."""
    process = subprocess.Popen(
        [sys.executable, str(HERE / 'sample_node.py')], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout.readline().startswith('sample is up')
    yield process
    end(process)


@pytest.fixture
def output(capsys):
    """Run a command line that succeeds and return what it prints."""

    def run(*words: str) -> str:
        assert main(words) == 0
        return capsys.readouterr().out

    return run


@pytest.fixture
def error(capsys):
    """Run a command line that fails and return its complaint."""

    def run(*words: str) -> str:
        assert main(words) == 1
        return capsys.readouterr().err

    return run


@pytest.fixture(scope='module', autouse=True)
def _isolated(own_domain: int) -> None:
    """Keep the processes of these tests among themselves."""
