# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""No fault of process, disk, files or plan changes a result: a row is as undisturbed, or lost."""

from __future__ import annotations

import os
import random
import shutil
import subprocess
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hexapod_doe.bags.run_record import find_bags
from hexapod_doe.bags.verify import digest

from .fleet_faults import CONFIG, FAULTS, Victim

pytestmark = [pytest.mark.system, pytest.mark.slow, pytest.mark.timeout(7200)]
WANTED = 100
ROUND = 13
"""Faults of one campaign; the next one begins anew."""


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[Callable[[str], Path]]:
    """Return what makes folders that are disks of 8 MB."""
    if shutil.which('mount') is None or os.geteuid() != 0:
        pytest.skip('to mount a file system needs root')
    made: list[Path] = []

    def mount(name: str) -> Path:
        folder = tmp_path / name
        folder.mkdir()
        line = ['mount', '-t', 'tmpfs', '-o', 'size=8m', 'none', str(folder)]
        if subprocess.run(line, capture_output=True, check=False).returncode:
            pytest.skip('this machine does not let tests mount a file system')
        made.append(folder)
        return folder

    yield mount
    for folder in made:
        subprocess.run(['umount', '-l', str(folder)], check=True)


def test_a_hundred_faults_change_no_result(tmp_path: Path, disk, capsys) -> None:
    config = tmp_path / 'config.yaml'
    config.write_text(CONFIG)
    rng = random.Random(2026)
    calm = Victim(disk('calm'), config, rng)
    assert calm.end(calm.begin()) == 0, calm.told
    expected = {bag.name: digest(bag) for bag in find_bags(calm.folder)}
    assert len(expected) == 4
    struck: Counter[str] = Counter()
    while struck.total() < WANTED:
        victim = Victim(disk(f'round_{struck.total()}'), config, rng)
        for _ in range(ROUND):
            # The rarest so far; several need a finished bag, or a row that is not.
            kinds = sorted(FAULTS, key=lambda kind: (struck[kind.__name__], rng.random()))
            kind = next(kind for kind in kinds if kind(victim))
            struck[kind.__name__] += 1
            assert victim.judge(expected) == [], kind.__name__
        assert victim.end(victim.begin()) == 0, victim.told
        assert {row.run_id: digest(row.bag) for row in victim.rows} == expected
        assert not list(victim.folder.glob('runs/*.checkpoint.pt'))
        assert not list(victim.folder.glob('runs/*.cut_*'))
    with capsys.disabled():
        print(f'\n{struck.total()} faults judged, results equal to the last bit: {dict(struck)}')
    assert set(struck) == {fault.__name__ for fault in FAULTS}
