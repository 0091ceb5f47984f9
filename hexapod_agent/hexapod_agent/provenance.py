# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a run was made with: versions of the libraries, of the interpreter and of this code."""

from __future__ import annotations

import platform
import subprocess
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

_LIBRARIES = ('numpy', 'torch', 'mujoco', 'gymnasium', 'rclpy')


@lru_cache(maxsize=1)
def provenance() -> dict[str, str]:
    """Return names and versions; what is not installed or not known is 'unknown'."""
    found = {f'version.{name}': _version(name) for name in _LIBRARIES}
    return found | {
        'version.python': platform.python_version(),
        'machine': platform.machine(),
        'git_commit': _git_commit(),
    }


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return 'unknown'


def _git_commit() -> str:
    """Return the commit of the checkout that this file is in, with '+' if it was changed."""
    try:
        text = subprocess.run(
            ['git', 'describe', '--always', '--abbrev=40', '--dirty=+'],
            cwd=Path(__file__).resolve().parent,
            capture_output=True,
            text=True,
            check=True,
            timeout=10.0,
        )
    except (OSError, subprocess.SubprocessError):
        return 'unknown'
    return text.stdout.strip()
