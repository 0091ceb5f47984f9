# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a batch system gives a process is what it uses."""

import os
import subprocess
import sys

import pytest
from hexapod_doe.cores import usable_cores


@pytest.fixture
def groups(tmp_path, monkeypatch):
    """Return what lays out control groups, for a process that may run on eight cores."""
    monkeypatch.setattr(os, 'sched_getaffinity', lambda process: set(range(8)))

    def lay(member: str, **files: str) -> int:
        (tmp_path / 'member').write_text(member)
        for name, text in files.items():
            file = tmp_path / 'groups' / name.replace('__', '/').replace('_max', '.max')
            file = file.with_name(file.name.replace('cpu_cfs', 'cpu.cfs'))
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        return usable_cores(tmp_path / 'groups', tmp_path / 'member')

    return lay


def test_without_groups_the_affinity_counts(groups):
    assert groups('') == 8
    assert groups('0::/\n') == 8


@pytest.mark.parametrize(
    ('quota', 'cores'), [('max 100000', 8), ('350000 100000', 3), ('20000 100000', 1)]
)
def test_a_quota_pays_for_whole_cores(groups, quota, cores):
    assert groups('0::/job/step\n', job__step__cpu_max=quota) == cores


def test_the_quota_of_a_group_above_holds_too(groups):
    assert groups('0::/job/step\n', job__cpu_max='200000 100000', job__step__cpu_max='max 1') == 2


def test_the_first_version_of_control_groups(groups):
    member = '4:memory:/\n3:cpu,cpuacct:/job\n'
    files = {'cpu,cpuacct__job__cpu_cfs_quota_us': '200000'}
    assert groups(member, **files, **{'cpu,cpuacct__job__cpu_cfs_period_us': '100000'}) == 2
    assert groups(member, **files | {'cpu,cpuacct__job__cpu_cfs_quota_us': '-1'}) == 8


def test_the_affinity_of_a_job_is_what_it_gets():
    code = 'from hexapod_doe.cores import usable_cores; print(usable_cores())'
    core = min(os.sched_getaffinity(0))
    found = subprocess.run(
        ['taskset', '-c', str(core), sys.executable, '-c', code], capture_output=True, text=True
    )
    assert found.stdout.strip() == '1'
