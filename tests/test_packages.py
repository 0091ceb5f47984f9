# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Each package's package.xml, setup.py and code say the same."""

import ast
import re
import sys
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
from catkin_pkg.package import Package, parse_package

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / 'ros_ws' / 'src'
PACKAGES = sorted(path.name for path in SOURCES.iterdir() if (path / 'package.xml').is_file())
PYTHON = [name for name in PACKAGES if (SOURCES / name / 'setup.py').is_file()]
# rosdep's keys of the libraries; '' where it has none, and requirements.txt alone names it.
ROSDEP_KEYS = {
    'PIL': 'python3-pil',
    'annotated_types': '',
    'gymnasium': 'python3-gymnasium-pip',
    'jinja2': 'python3-jinja2',
    'matplotlib': 'python3-matplotlib',
    'mcap': 'mcap-ros2-support',
    'mcap_ros2': 'mcap-ros2-support',
    'mujoco': 'python3-mujoco-pip',
    'numpy': 'python3-numpy',
    'onnx': '',
    'pandas': 'python3-pandas',
    'pydantic': 'python3-pydantic',
    'rich': 'python3-rich',
    'scipy': 'python3-scipy',
    'statsmodels': '',
    'tensorboardX': 'python3-tensorboardX-pip',
    'torch': 'python3-torch',
    'yaml': 'python3-yaml',
    'zstandard': '',
}
# Used where it is installed, and not asked for.
OPTIONAL = {'imageio_ffmpeg'}


@cache
def imported(package: str) -> set[str]:
    """Return the top-level names that a package's code imports, its own and Python's apart."""
    found = set()
    for file in (SOURCES / package / package).rglob('*.py'):
        for node in ast.walk(ast.parse(file.read_text(encoding='utf-8'))):
            if isinstance(node, ast.Import):
                found |= {alias.name.split('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module:
                found.add(node.module.split('.')[0])
    return found - set(sys.stdlib_module_names) - OPTIONAL - {package}


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
    assert sorted(needed - named) == []
    # A launch file may need a package that no code imports.
    launched = ''.join(file.read_text() for file in (SOURCES / package).glob('launch/*.xml'))
    assert [name for name in sorted(named - needed) if f'"{name}"' not in launched] == []
    assert {dependency.name for dependency in manifest.test_depends} == {'python3-pytest'}


def test_libraries_without_a_key_are_required_by_pip() -> None:
    text = (ROOT / 'requirements.txt').read_text().lower()
    required = {re.split(r'[=<>\s]', line)[0] for line in text.splitlines() if line[:1].isalpha()}
    used = set().union(*map(imported, PYTHON))
    bare = {name for name in used if ROSDEP_KEYS.get(name) == ''}
    assert {name.lower().replace('_', '-') for name in bare} <= required
    assert sorted(name for name, key in ROSDEP_KEYS.items() if not key and name not in used) == []


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
    folder = (SOURCES / package).resolve()
    listed = (folder / 'setup.cfg').read_text().split('testpaths =\n')[1].split('addopts')[0]
    paths = [folder / line.strip() for line in listed.splitlines() if line.strip()]
    assert all(path.exists() for path in paths)
    assert ROOT / 'tests' / package in [path.resolve() for path in paths]
