# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The requirements of a stock ROS 2 Jazzy: those of the wheels, but for its numpy."""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import requires, version
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.version import Version

ROOT = Path(__file__).resolve().parents[1]
STOCK_PYTHON, STOCK_NUMPY = '3.12', '1.26.4'
# Ubuntu 24.04 has glibc 2.39; pip knows of a platform only the tags that it is told.
PLATFORMS = ('manylinux_2_28', 'manylinux_2_27', 'manylinux_2_17', 'manylinux2014')


def read(name: str) -> dict[str, Requirement]:
    """Return the requirements of a file by name."""
    lines = (line.split('#')[0].strip() for line in (ROOT / name).read_text().splitlines())
    made = [Requirement(line) for line in lines if line]
    return {requirement.name.lower(): requirement for requirement in made}


STOCK = read('requirements-stock.txt')


def pin(requirement: Requirement) -> str:
    """Return the one version that a requirement allows."""
    (specifier,) = requirement.specifier
    assert specifier.operator == '=='
    return specifier.version


def test_a_stock_machine_gets_the_same_libraries() -> None:
    wheels = read('requirements.txt')
    assert STOCK.keys() == wheels.keys() | {'setuptools'}
    assert pin(STOCK['setuptools']) == pin(read('requirements-ros.txt')['setuptools'])
    differ = {name for name in wheels if str(wheels[name]) != str(STOCK[name])}
    assert differ == {'numpy', 'pandas'}
    assert pin(STOCK['numpy']) == STOCK_NUMPY
    assert wheels['numpy'].specifier.contains(STOCK_NUMPY)


@pytest.mark.parametrize('name', sorted(STOCK.keys() - {'numpy', 'pandas'}))
def test_each_takes_the_others_as_they_are_pinned(name: str) -> None:
    assert Version(version(name)).public == pin(STOCK[name]), 'the judged one is installed'
    machine = {'python_version': STOCK_PYTHON, 'python_full_version': f'{STOCK_PYTHON}.3'}
    for text in requires(name) or []:
        needed = Requirement(text)
        other = STOCK.get(needed.name.lower())
        if other and (needed.marker is None or needed.marker.evaluate({**machine, 'extra': ''})):
            assert needed.specifier.contains(pin(other)), text


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_pip_resolves_them_for_a_stock_machine(tmp_path) -> None:
    """From the package index, for Python 3.12; torch apart, whose CUDA this pip would download."""
    lines = [str(STOCK[name]) for name in STOCK if name != 'torch']
    (tmp_path / 'requirements.txt').write_text('\n'.join(lines))
    options = ['--dry-run', '--ignore-installed', '--only-binary=:all:', '--no-cache-dir']
    options.append(f'--python-version={STOCK_PYTHON}')
    places = [f'--target={tmp_path}', f'--requirement={tmp_path}/requirements.txt']
    platforms = [f'--platform={tag}_x86_64' for tag in PLATFORMS]
    ended = subprocess.run(
        [sys.executable, '-m', 'pip', 'install', *options, *platforms, *places],
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr
    (would,) = [line for line in ended.stdout.splitlines() if line.startswith('Would install')]
    assert {f'numpy-{STOCK_NUMPY}', 'pandas-3.0.6', 'setuptools-79.0.1'} <= set(would.split())
