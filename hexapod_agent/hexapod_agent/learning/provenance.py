# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a run was made with: libraries, interpreter, processor and this code.

Its numbers depend on them to the last bit: numpy and torch choose by version and by the
processor's instructions in which order a product of matrices is summed.
"""

import platform
import subprocess
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

_LIBRARIES = ('numpy', 'torch', 'mujoco', 'gymnasium', 'rclpy')
_PROCESSORS = Path('/proc/cpuinfo')
# What libraries choose their arithmetic by.
_FLAGS = ('avx2', 'fma', 'avx512f', 'avx512_vnni', 'avx512_bf16', 'amx_bf16')


@lru_cache(maxsize=1)
def provenance() -> dict[str, str]:
    """Return names and versions; what is not installed or not known is 'unknown'."""
    found = {f'version.{name}': _version(name) for name in _LIBRARIES}
    return found | {
        'version.python': platform.python_version(),
        'machine': platform.machine(),
        'processor': _processor(),
        'git_commit': _git_commit(),
    }


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return 'unknown'


def _processor() -> str:
    """Return the processor's maker and the instructions that arithmetic is chosen by."""
    try:
        lines = _PROCESSORS.read_text(encoding='utf-8').splitlines()
    except OSError:
        return 'unknown'
    entries = dict(line.replace('\t', '').split(':', 1) for line in lines if ':' in line)
    flags = entries.get('flags', '').split()
    return ' '.join(
        [entries.get('vendor_id', 'unknown').strip(), *(flag for flag in _FLAGS if flag in flags)]
    )


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
