# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A wall clock that is set back or forward in mid-campaign changes nothing in its bags."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from .short_campaign import TWO_RUNS, ShortCampaign

pytestmark = pytest.mark.system


@pytest.fixture
def jump(tmp_path: Path, monkeypatch) -> Path:
    """Build the clock and have new processes use it; return the file that sets it."""
    compiler = shutil.which('cc') or shutil.which('gcc')
    if compiler is None:
        pytest.skip('to build the clock needs a C compiler')
    library = tmp_path / 'jumping_clock.so'
    source = Path(__file__).with_name('jumping_clock.c')
    options = ['-shared', '-fPIC', '-O1', '-Wall', '-Werror', '-o', str(library), str(source)]
    subprocess.run([compiler, *options, '-ldl'], check=True)
    monkeypatch.setenv('HEXAPOD_JUMP', str(tmp_path / 'jump'))
    monkeypatch.setenv('LD_PRELOAD', str(library))
    return tmp_path / 'jump'


def set_clock(jump: Path, seconds: int) -> None:
    new = jump.with_suffix('.new')
    new.write_text(str(seconds))
    os.replace(new, jump)


def bags_begun(campaign: ShortCampaign) -> set[str]:
    return {file.parent.name.removesuffix('.partial') for file in campaign.runs.glob('*/*.mcap')}


def test_the_clock_of_the_test_jumps(shell, jump: Path) -> None:
    set_clock(jump, -86400)
    found = shell.run('date +%s')
    assert -86500 < int(found.stdout) - jump.stat().st_mtime < -86300


def test_a_clock_that_jumps_changes_nothing(shell, jump: Path) -> None:
    campaign = ShortCampaign(shell, shell.directory / 'campaign', TWO_RUNS, 40)
    manager = campaign.start(workers=1)
    for run, seconds in enumerate((-3600, 3600), 1):  # amid the first run back, and then forward
        shell.until(lambda least=run: len(bags_begun(campaign)) >= least, timeout_s=60.0)
        set_clock(jump, seconds)
    assert manager.wait(100.0) == 0, shell.output()
    assert 'due again' not in shell.output()
    campaign.assert_as_alone()
