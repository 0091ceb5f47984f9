# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A campaign whose processes are stopped and continued at random ends, with the same results.

So does an overloaded machine, a suspended laptop, a virtual machine that moves.
`HEXAPOD_PAUSES` and `HEXAPOD_PAUSE_SEED` say how often and by which seed.
"""

from __future__ import annotations

import os
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

from .short_campaign import ShortCampaign
from .storm import children

pytestmark = pytest.mark.system
SEED = int(os.environ.get('HEXAPOD_PAUSE_SEED', '1'))
PAUSES = int(os.environ.get('HEXAPOD_PAUSES', '200'))
EIGHT_RUNS = '--generators D=ABC --factors 4'
FEW_RUNS = '--generators B=A --factors 2'


def family(pid: int) -> list[int]:
    """Return a process and all that it has started, and these."""
    return [pid, *(other for child in children(pid) for other in family(child))]


def pause_at_random(manager: subprocess.Popen[str], count: int, seed: int) -> int:
    """Stop and continue processes of a campaign; return how often that was possible."""
    chance = np.random.default_rng(seed)
    paused = 0
    while paused < count and manager.poll() is None:
        alive = family(manager.pid)
        several = chance.choice(alive, size=int(chance.integers(1, len(alive) + 1)), replace=False)
        victims = [int(pid) for pid in several]
        send(victims, signal.SIGSTOP)
        time.sleep(float(chance.choice([0.03, 0.06, 0.12, 0.25, 0.5, 2.0])))
        send(victims, signal.SIGCONT)
        time.sleep(float(chance.choice([0.0005, 0.002, 0.01, 0.05, 0.3])))
        paused += 1
    return paused


def send(processes: list[int], what: signal.Signals) -> None:
    for pid in processes:
        if Path(f'/proc/{pid}').exists():
            os.kill(pid, what)


@pytest.mark.parametrize(
    ('design', 'episodes', 'count'),
    [
        pytest.param(FEW_RUNS, 24, 6, id='some'),
        pytest.param(EIGHT_RUNS, 600, PAUSES, id='all', marks=pytest.mark.slow),
    ],
)
@pytest.mark.timeout(3600)
def test_a_campaign_that_is_paused_ends_with_the_results_of_an_undisturbed_one(
    shell, tmp_path: Path, design: str, episodes: int, count: int
) -> None:
    campaign = ShortCampaign(shell, tmp_path / 'c', design, episodes)
    manager = campaign.start(workers=2, stall_timeout=60.0)
    shell.until(lambda: any(campaign.runs.glob('*.partial')), 60.0)
    paused = pause_at_random(manager, count, SEED)
    assert paused == count, f'the campaign ended after {paused} pauses'
    assert manager.wait(1200.0) == 0, shell.output()
    campaign.assert_as_alone()
