# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Each package's package.xml, setup.py and code say the same."""

import ast
import os
import re
import subprocess
import sys
from collections.abc import Iterable
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
from catkin_pkg.package import Package, parse_package
from hexapod_sim.sensor_table import CHANNELS

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / 'ros_ws' / 'src'
PACKAGES = sorted(path.name for path in SOURCES.iterdir() if (path / 'package.xml').is_file())
PYTHON = [name for name in PACKAGES if (SOURCES / name / 'setup.py').is_file()]
SHARED = {file.stem: file for file in (ROOT / 'tests' / 'support').glob('*.py')}
# rosdep's keys of the libraries; '' where it has none, and requirements.txt alone names it.
ROSDEP_KEYS = {
    'PIL': 'python3-pil',
    'annotated_types': '',
    'cmaes': '',
    'gymnasium': 'python3-gymnasium-pip',
    'hypothesis': 'python3-hypothesis',
    'jinja2': 'python3-jinja2',
    'matplotlib': 'python3-matplotlib',
    'mcap': 'mcap-ros2-support',
    'mcap_ros2': 'mcap-ros2-support',
    'mujoco': 'python3-mujoco-pip',
    'numpy': 'python3-numpy',
    'onnx': '',
    'onnxruntime': 'python3-onnxruntime-pip',
    'pandas': 'python3-pandas',
    'pydantic': 'python3-pydantic',
    'pytest': 'python3-pytest',
    'rich': 'python3-rich',
    'rosbags': '',
    'scipy': 'python3-scipy',
    'stable_baselines3': '',
    'statsmodels': '',
    'tensorboardX': 'python3-tensorboardX-pip',
    'torch': 'python3-torch',
    'yaml': 'python3-yaml',
    'zstandard': '',
}
# Used where it is installed, and not asked for.
OPTIONAL = {'imageio_ffmpeg'}


def names_in(files: Iterable[Path]) -> set[str]:
    """Return the top-level names that files import, Python's own apart."""
    found = set()
    for file in files:
        for node in ast.walk(ast.parse(file.read_text(encoding='utf-8'))):
            if isinstance(node, ast.Import):
                found |= {alias.name.split('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module:
                found.add(node.module.split('.')[0])
    return found - set(sys.stdlib_module_names)


@cache
def imported(package: str) -> set[str]:
    """Return what a package's code needs, itself apart."""
    files = (SOURCES / package / package).rglob('*.py')
    return names_in(files) - OPTIONAL - {package}


def own_tests(package: str) -> list[Path]:
    """Return the files and folders that `colcon test` runs for a package."""
    folder = (SOURCES / package).resolve()
    listed = (folder / 'setup.cfg').read_text().split('testpaths =\n')[1].split('addopts')[0]
    return [(folder / line.strip()).resolve() for line in listed.splitlines() if line.strip()]


@cache
def imported_by_tests(package: str) -> set[str]:
    """Return what a package's tests need, our own packages apart: all of them are built first."""
    paths = own_tests(package)
    files = {file for path in paths for file in (path.rglob('*.py') if path.is_dir() else [path])}
    above = {folder / 'conftest.py' for path in paths for folder in path.parents}
    files |= {file for file in above if file.is_file()}
    names = names_in(files)
    while shared := names & SHARED.keys():
        names = names - shared | names_in(map(SHARED.__getitem__, shared))
    return names - {'conftest', *PACKAGES}


@pytest.fixture(params=PACKAGES)
def manifest(request) -> Package:
    return parse_package(str(SOURCES / request.param / 'package.xml'))


def test_manifest_is_valid(manifest) -> None:
    found: list[str] = []
    manifest.validate(warnings=found)
    assert found == []
    assert manifest.package_format == 3
    assert manifest.name in PACKAGES
    assert manifest.licenses == ['Apache-2.0']
    assert manifest.get_build_type() in ('ament_python', 'ament_cmake')


@pytest.mark.parametrize('package', PYTHON)
def test_manifest_names_what_the_code_imports(package: str) -> None:
    manifest = parse_package(str(SOURCES / package / 'package.xml'))
    named = {dependency.name for dependency in manifest.exec_depends}
    needed = {ROSDEP_KEYS.get(name, name) for name in imported(package)} - {''}
    if package == 'hexapod_sim':  # loaded by the names that its sensor table has
        needed |= {row.message_type.split('/')[0] for row in CHANNELS if row.message_type}
    assert sorted(needed - named) == []
    # A launch file may need a package that no code imports.
    launched = ''.join(file.read_text() for file in (SOURCES / package).glob('launch/*.xml'))
    assert [name for name in sorted(named - needed) if f'"{name}"' not in launched] == []
    tested = {ROSDEP_KEYS.get(name, name) for name in imported_by_tests(package)} - {''}
    said = {dependency.name for dependency in manifest.test_depends}
    assert sorted(said) == sorted(tested - named)


def required(file: str) -> set[str]:
    """Return the names that a requirements file asks for."""
    text = (ROOT / file).read_text().lower()
    return {re.split(r'[=<>\s]', line)[0] for line in text.splitlines() if line[:1].isalpha()}


def test_libraries_without_a_key_are_required_by_pip() -> None:
    def bare(used: set[str]) -> set[str]:
        return {name.lower().replace('_', '-') for name in used if ROSDEP_KEYS.get(name) == ''}

    used = set().union(*map(imported, PYTHON))
    tested = set().union(*map(imported_by_tests, PYTHON))
    assert bare(used) <= required('requirements.txt')
    assert bare(tested) <= required('requirements.txt') | required('requirements-dev.txt')
    assert [n for n, key in ROSDEP_KEYS.items() if not key and n not in used | tested] == []


@pytest.mark.parametrize('package', PYTHON)
def test_setup_and_manifest_agree(package: str) -> None:
    manifest = parse_package(str(SOURCES / package / 'package.xml'))
    text = (SOURCES / package / 'setup.py').read_text(encoding='utf-8')
    (call,) = [n for n in ast.walk(ast.parse(text)) if isinstance(n, ast.Call) and n.keywords
               and getattr(n.func, 'id', '') == 'setup']  # fmt: skip
    said = {k.arg: ast.literal_eval(k.value) for k in call.keywords
            if k.arg in ('version', 'license', 'maintainer', 'maintainer_email')}  # fmt: skip
    (maintainer,) = manifest.maintainers
    assert said == {
        'version': manifest.version,
        'license': manifest.licenses[0],
        'maintainer': maintainer.name,
        'maintainer_email': maintainer.email,
    }
    assert "extras_require={'test': ['pytest']}" in text  # what makes colcon run the tests
    assert (SOURCES / package / 'resource' / package).is_file()
    assert f'install_scripts=$base/lib/{package}' in (SOURCES / package / 'setup.cfg').read_text()


@pytest.mark.parametrize('package', PYTHON)
def test_every_command_can_be_started(package: str) -> None:
    text = (SOURCES / package / 'setup.py').read_text(encoding='utf-8')
    for name, module, function in re.findall(r"'(\w+) = ([\w.]+):(\w+)'", text):
        assert callable(getattr(import_module(module), function)), name


@pytest.mark.parametrize('package', PYTHON)
def test_colcon_finds_the_tests(package: str) -> None:
    paths = own_tests(package)
    assert all(path.exists() for path in paths)
    assert ROOT / 'tests' / package in paths


def test_colcon_test_survives_the_plugins_of_launch_testing(tmp_path: Path) -> None:
    # As ROS 2 Jazzy's hooks declare it: pytest 9 knows no argument `path`.
    (tmp_path / 'ros_hooks.py').write_text('def pytest_pycollect_makemodule(path, parent): ...\n')
    information = tmp_path / 'launch_testing-3.4.3.dist-info'
    information.mkdir()
    (information / 'METADATA').write_text('Name: launch_testing\nVersion: 3.4.3\n')
    (information / 'entry_points.txt').write_text(
        '[pytest11]\nlaunch_testing = ros_hooks\nlaunch_ros = ros_hooks\n'
    )
    command = [sys.executable, '-m', 'pytest', '-q', '--collect-only', '-p', 'no:cacheprovider']
    path = os.pathsep.join([str(tmp_path), os.environ.get('PYTHONPATH', '')])
    package = (SOURCES / 'hexapod_cpg').resolve()
    statuses = {
        folder: subprocess.run(
            command,
            cwd=folder,
            env=os.environ | {'PYTHONPATH': path},
            capture_output=True,
            check=False,
        ).returncode
        for folder in (package, tmp_path)
    }
    assert statuses[package] == 0
    # The plugin is there, and does not load without that option.
    assert statuses[tmp_path] not in (0, pytest.ExitCode.NO_TESTS_COLLECTED)
