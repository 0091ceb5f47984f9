# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How many cores this process may use: not what the machine has, but what a batch system gives."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path

_CGROUPS = Path('/sys/fs/cgroup')
_MEMBERSHIP = Path('/proc/self/cgroup')


def usable_cores(cgroups: Path = _CGROUPS, membership: Path = _MEMBERSHIP) -> int:
    """Return the cores that the affinity allows, or the whole ones that a quota pays for if fewer.

    Args:
        cgroups: where the control groups are mounted.
        membership: file that says which groups this process is in.
    """
    allowed = len(os.sched_getaffinity(0))
    shares = [int(share) for share in _quotas(cgroups, membership)]
    return max(1, min([allowed, *shares]))


def _quotas(cgroups: Path, membership: Path) -> Iterator[float]:
    """Yield the cores that each group around this process may use, where that is limited."""
    try:
        lines = membership.read_text(encoding='utf-8').splitlines()
    except OSError:
        return
    for line in lines:
        _, controllers, path = line.split(':', 2)
        if not controllers:  # version 2
            yield from _walk(cgroups, path, _quota)
        elif 'cpu' in controllers.split(','):
            yield from _walk(cgroups / controllers, path, _old_quota)


def _walk(mount: Path, path: str, read: Callable[[Path], float | None]) -> Iterator[float]:
    """Yield what a group and those above it allow; in a container only the mount may be seen."""
    group = mount / path.lstrip('/')
    for folder in (group, *group.parents):
        if (share := read(folder)) is not None:
            yield share
        if folder == mount:
            return


def _quota(group: Path) -> float | None:
    words = _words(group / 'cpu.max')
    return int(words[0]) / int(words[1]) if len(words) == 2 and words[0] != 'max' else None


def _old_quota(group: Path) -> float | None:
    quota, period = _words(group / 'cpu.cfs_quota_us'), _words(group / 'cpu.cfs_period_us')
    return int(quota[0]) / int(period[0]) if quota and period and int(quota[0]) > 0 else None


def _words(file: Path) -> list[str]:
    try:
        return file.read_text(encoding='utf-8').split()
    except OSError:
        return []
