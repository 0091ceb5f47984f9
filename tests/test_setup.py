# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`source setup.bash` in the shells, options and environments that people have."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SHELLS = [name for name in ('bash', 'zsh') if shutil.which(name)]
# What colcon's and venv's own files do: read what is unset, and go on after what fails.
CARELESS = 'if [ -n "$NOT_SET_AT_ALL" ]; then false; fi\nfalse\nexport WORKSPACE_READY=yes\n'


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """The project's folder with a workspace that only says that it was sourced."""
    root = tmp_path / 'a project'
    (root / 'ros_ws/install').mkdir(parents=True)
    (root / '.ci').mkdir()
    for name in ('setup.bash', '.ci/other_ros'):
        shutil.copy(ROOT / name, root / name)
    for shell in ('bash', 'zsh'):
        (root / 'ros_ws/install' / f'setup.{shell}').write_text(CARELESS)
    return root


def ended(
    shell: str, script: str, directory: Path, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run a script in a shell that inherits nothing but a path."""
    return subprocess.run(
        [shell, '-c', script],
        cwd=directory,
        env={'PATH': os.environ['PATH'], **environment},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize('shell', SHELLS)
@pytest.mark.parametrize('options', ['', 'set -u', 'set -e', 'set -eu -o pipefail'])
def test_a_careful_script_sources_it_and_keeps_its_options(project, shell, options) -> None:
    script = (
        f'{options}\nbefore=$-\nsource ./setup.bash\n[ "$-" = "$before" ] && echo $WORKSPACE_READY'
    )
    result = ended(shell, script, project)
    assert (result.stdout, result.stderr, result.returncode) == ('yes\n', '', 0)


@pytest.mark.parametrize('shell', SHELLS)
@pytest.mark.parametrize('where', ["'a project/setup.bash'", "./'a project'/setup.bash"])
def test_from_another_folder_with_cdpath_and_field_separators(project, shell, where) -> None:
    script = f'cd .; source {where}; echo $WORKSPACE_READY $ROS_AUTOMATIC_DISCOVERY_RANGE'
    result = ended(shell, script, project.parent, CDPATH='.:/', IFS='\n\t')
    assert (result.stdout, result.returncode) == ('yes LOCALHOST\n', 0)


@pytest.mark.parametrize('shell', SHELLS)
def test_nothing_of_its_own_stays(project, shell) -> None:
    names = 'typeset -f | grep -c hexapod; set | grep -ci ^_hexapod'
    assert ended(shell, f'source ./setup.bash; {names}', project).stdout == '0\n0\n'


def test_the_system_s_sh_is_refused_where_it_is_not_bash(project) -> None:
    if os.path.realpath(shutil.which('sh') or '').endswith('bash'):
        assert 'yes' in ended('sh', '. ./setup.bash; echo $WORKSPACE_READY', project).stdout
        return
    result = ended('sh', '. ./setup.bash && echo next', project)
    assert result.returncode != 0
    assert result.stdout == ''
    (line,) = result.stderr.splitlines()
    assert 'neither bash nor zsh' in line


@pytest.mark.parametrize('shell', ['sh', *SHELLS])
def test_to_run_it_is_refused(project, shell) -> None:
    result = ended(shell, f'{shell} setup.bash', project)
    assert result.returncode == 1
    (line,) = result.stderr.splitlines()
    assert 'expected' in line


@pytest.mark.parametrize('shell', SHELLS)
@pytest.mark.parametrize(
    ('environment', 'named'),
    [
        ({'ROS_DISTRO': 'humble'}, "'humble'"),
        ({'ROS_DISTRO': 'rolling', 'PYTHONPATH': '/opt/ros/rolling'}, "'rolling'"),
        ({'PYTHONPATH': '/nowhere:{foreign}'}, '{foreign}'),
    ],
)
def test_another_distribution_is_named(project, tmp_path, shell, environment, named) -> None:
    foreign = tmp_path / 'site-packages'
    (foreign / 'rclpy').mkdir(parents=True)
    filled = {name: text.format(foreign=foreign) for name, text in environment.items()}
    result = ended(shell, 'source ./setup.bash || exit 3', project, **filled)
    assert result.returncode == 3
    (line,) = result.stderr.splitlines()
    assert named.format(foreign=foreign) in line
    assert 'expected jazzy or none' in line
    made = subprocess.run(
        ['make', '-C', str(ROOT), 'other-ros'],
        env=os.environ | {'PYTHONPATH': '', **filled, 'ROS_DISTRO': filled.get('ROS_DISTRO', '')},
        capture_output=True,
        text=True,
        check=False,
    )
    assert made.returncode != 0
    assert line in made.stderr


@pytest.mark.parametrize('shell', SHELLS)
def test_jazzy_itself_passes(project, shell) -> None:
    result = ended(shell, 'source ./setup.bash', project, ROS_DISTRO='jazzy', PYTHONPATH='/x')
    assert (result.stderr, result.returncode) == ('', 0)


@pytest.mark.parametrize('shell', SHELLS)
def test_without_a_workspace_make_setup_is_named(project, shell) -> None:
    shutil.rmtree(project / 'ros_ws')
    result = ended(shell, 'set -u; source ./setup.bash; exit $?', project)
    assert result.returncode == 1
    assert "run 'make setup'" in result.stderr


def test_a_slurm_job_with_a_careful_first_line_runs() -> None:
    # docs/tutorials/batch.md's job, in the real workspace; status 2: there is no such plan
    command = 'exec ros2 run hexapod_doe campaign_status bags/nowhere'
    script = f'set -euo pipefail\nsource setup.bash\n{command}'
    venv = {name: os.environ[name] for name in ('HEXAPOD_VENV',) if name in os.environ}
    result = ended('bash', script, ROOT, HOME=os.environ['HOME'], **venv)
    assert result.returncode == 2
    assert 'Traceback' not in result.stderr


def test_a_clone_that_writes_carriage_returns_gets_none(tmp_path) -> None:
    shutil.copy(ROOT / '.gitattributes', tmp_path)
    texts = ('setup.bash', 'Makefile', '.ci/prerequisites', 'tests/data/doe_cases/plasma_2_4.csv')
    for name in texts:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    git = ['git', '-c', 'core.autocrlf=true', '-C', str(tmp_path)]
    subprocess.run([*git, 'init', '-q'], check=True)
    subprocess.run([*git, 'add', '.'], check=True, capture_output=True)
    subprocess.run([*git, 'checkout-index', '-a', '--prefix=clone/'], check=True)
    assert all((tmp_path / 'clone' / name).read_bytes().count(b'\r') == 0 for name in texts[:-1])
    assert all(
        (tmp_path / 'clone' / name).read_bytes() == (ROOT / name).read_bytes() for name in texts
    )
