# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Faults of a campaign without the graph: of its process, its disk, its files and its plan.

Each fault is a function of a `Victim` that returns whether there was something to break.
"""

from __future__ import annotations

import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from hexapod_doe.bags.verify import digest
from hexapod_doe.campaigns.folder import read_progress, verify_done
from hexapod_doe.campaigns.progress import State
from hexapod_doe.campaigns.row import Row, read_rows

PLAN = ('--generators', 'C=AB', '--factors', 'ABC')
EPISODES = 12
CONFIG = """
task: {time_limit_steps: 40}
actor: {hidden: [16, 12]}
critic: {hidden: [16, 12]}
ddpg: {batch_size: 16, buffer_size: 5000, update_every: 8}
training: {evaluation: 2, checkpoint_every: 2, window: 2}
"""
_START_S = 60.0


class Victim:
    """One campaign and what is done to it.

    Attributes:
        folder: of the campaign.
        rng: decides when and where.
        told: what its commands said on standard error.
    """

    def __init__(self, folder: Path, config: Path, rng: random.Random) -> None:
        """Plan the campaign.

        Args:
            folder: a disk of its own, small enough to be filled.
            config: of its runs.
            rng: decides when and where a fault strikes.
        """
        self.folder, self.rng, self._config = folder, rng, config
        self.told = ''
        assert self.plan('1').returncode == 0

    def plan(self, seed: str) -> subprocess.CompletedProcess[str]:
        """Plan the campaign, or plan it anew."""
        words = [*PLAN, '--seed', seed, '--out', str(self.folder / 'plan.csv')]
        command = [sys.executable, '-m', 'hexapod_doe.plan', *words]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    @property
    def rows(self) -> tuple[Row, ...]:
        """Rows of its plan."""
        return read_rows(self.folder / 'plan.csv')

    def done(self) -> list[Row]:
        """Return the rows that count as done; where none does, have one trained first."""
        if not self._done():
            fleet = self.begin()
            while fleet.poll() is None and not self._done():
                time.sleep(0.2)
            fleet.terminate()
            self.end(fleet)
        return self._done()

    def _done(self) -> list[Row]:
        return [row for row in self.rows if row.bag_state().done]

    def begin(self, episodes: int = EPISODES) -> subprocess.Popen[str]:
        """Start a fleet of one process."""
        words = ['--plan', str(self.folder / 'plan.csv'), '--config', str(self._config)]
        words += ['--episodes', str(episodes), '--processes', '1']
        command = [sys.executable, '-m', 'hexapod_doe.run_fleet', *words]
        pipe = subprocess.PIPE
        return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=pipe, text=True)

    def end(self, fleet: subprocess.Popen[str]) -> int:
        """Wait for a fleet, keep what it said, and return its status."""
        self.told = fleet.communicate(timeout=300.0)[1]
        return fleet.returncode

    def amid(self, pattern: str = '*.partial/*.mcap') -> subprocess.Popen[str]:
        """Start a fleet and return at some instant after a file has appeared, or at its end."""
        fleet = self.begin()
        deadline = time.monotonic() + _START_S
        while fleet.poll() is None and time.monotonic() < deadline:
            if any(path.exists() for path in (self.folder / 'runs').glob(pattern)):
                time.sleep(self.rng.uniform(0.0, 2.0))
                break
            time.sleep(0.01)
        return fleet

    def judge(self, expected: Mapping[str, str]) -> list[str]:
        """Return a line for each row that counts as done and is not as it was undisturbed."""
        progress = read_progress(self.folder)
        verify_done(progress, self.folder)
        bags = {row.run_id: row.bag for row in self.rows}
        return [
            f'{run.run_id} is done and differs'
            for run in progress.having(State.DONE)
            if digest(bags[run.run_id]) != expected[run.run_id]
        ]


def killed(victim: Victim) -> bool:
    """SIGKILL."""
    fleet = victim.amid()
    fleet.kill()
    return victim.end(fleet) == -signal.SIGKILL


def terminated(victim: Victim) -> bool:
    """SIGTERM, to which a fleet ends in order."""
    fleet = victim.amid()
    fleet.terminate()
    return victim.end(fleet) in (130, -signal.SIGTERM)


def stopped(victim: Victim) -> bool:
    """SIGSTOP for a while, then SIGTERM some time later."""
    fleet = victim.amid()
    fleet.send_signal(signal.SIGSTOP)
    time.sleep(0.4)
    fleet.send_signal(signal.SIGCONT)
    time.sleep(victim.rng.uniform(0.0, 0.4))
    fleet.terminate()
    return victim.end(fleet) in (130, -signal.SIGTERM)


def full_disk(victim: Victim) -> bool:
    """Fill the disk amid a run; the rows under way fail, and say why."""
    fleet = victim.amid()
    filler = victim.folder / 'thesis.pdf'
    try:
        with filler.open('wb') as file:
            while True:
                file.write(bytes(1 << 16))
    except OSError:
        pass
    status = victim.end(fleet)
    filler.unlink()
    if status:
        assert 'No space left' in victim.told + failures(victim), victim.told
    return status != 0


def failures(victim: Victim) -> str:
    """Return the reasons that the folder keeps."""
    file = victim.folder / 'failures.csv'
    return file.read_text() if file.exists() else 'No space left: nor for the reason'


def read_only(victim: Victim) -> bool:
    """Start on a disk that cannot be written."""
    remount(victim.folder, 'ro')
    status = victim.end(victim.begin())
    remount(victim.folder, 'rw')
    assert status == 2, victim.told
    assert 'Read-only file system' in victim.told
    return True


def remount(folder: Path, how: str) -> None:
    """Mount a disk once more, read-only or writable."""
    subprocess.run(['mount', '-o', f'remount,{how}', str(folder)], check=True)


def flip(path: Path, rng: random.Random) -> None:
    """Flip one bit of a file."""
    content = bytearray(path.read_bytes())
    content[rng.randrange(len(content))] ^= 1 << rng.randrange(8)
    path.write_bytes(content)


def rotten_checkpoint(victim: Victim) -> bool:
    """Kill a fleet after a checkpoint, and flip a bit of that."""
    fleet = victim.amid('*.checkpoint.pt')
    fleet.kill()
    victim.end(fleet)
    found = sorted((victim.folder / 'runs').glob('*.checkpoint.pt'))
    if found:
        flip(victim.rng.choice(found), victim.rng)
    return bool(found)


def rotten_bag(victim: Victim) -> bool:
    """Flip a bit of a finished bag: its row is lost, and says so."""
    row = victim.rng.choice(victim.done())
    flip(victim.rng.choice(sorted(row.bag.iterdir())), victim.rng)
    assert row.bag_state().damage
    return True


def cut_recording(victim: Victim) -> bool:
    """Kill a fleet and cut what it had recorded somewhere."""
    fleet = victim.amid()
    fleet.kill()
    victim.end(fleet)
    found = sorted((victim.folder / 'runs').glob('*.partial/*.mcap'))
    for file in found:
        content = file.read_bytes()
        file.write_bytes(content[: victim.rng.randrange(1 + len(content))])
    return bool(found)


def planned_anew(victim: Victim) -> bool:
    """Plan with another seed over the runs: refused."""
    victim.done()
    before = (victim.folder / 'plan.csv').read_bytes()
    made = victim.plan('2')
    assert made.returncode == 2
    assert 'a plan with runs' in made.stderr
    return before == (victim.folder / 'plan.csv').read_bytes()


def another_plan(victim: Victim) -> bool:
    """Put another plan in the place of the campaign's: none of its rows is done, none starts."""
    done = victim.done()
    plan = victim.folder / 'plan.csv'
    before = plan.read_text()
    plan.write_text(before.replace(f',{done[0].seed},', f',{done[0].seed + 1},'))
    assert not next(row for row in victim.rows if row.run_id == done[0].run_id).bag_state().done
    status = victim.end(victim.begin())
    plan.write_text(before)
    assert status == 2
    assert f'{done[0].run_id} (seed {done[0].seed}, expected {done[0].seed + 1})' in victim.told
    return True


def another_length(victim: Victim) -> bool:
    """Start with another number of episodes: the rows that are done are named."""
    done = victim.done()
    assert victim.end(victim.begin(EPISODES + 1)) == 2
    assert f'{done[0].run_id} (episodes {EPISODES}, expected' in victim.told
    return True


def linked_run(victim: Victim) -> bool:
    """Move a finished bag to another place and leave a link: it is still the row's."""
    done = [row for row in victim.done() if not row.bag.is_symlink()]
    if not done:
        return False
    row = victim.rng.choice(done)
    elsewhere = victim.folder / 'elsewhere' / f'{row.run_id}_{victim.rng.randrange(10**6)}'
    elsewhere.parent.mkdir(exist_ok=True)
    row.bag.rename(elsewhere)
    row.bag.symlink_to(elsewhere)
    assert row.bag_state().done
    return True


def lost_link(victim: Victim) -> bool:
    """Put a link that leads nowhere in the place of a finished bag: its row is lost."""
    row = victim.rng.choice(victim.done())
    if row.bag.is_symlink():
        row.bag.unlink()
    else:
        shutil.rmtree(row.bag)
    row.bag.symlink_to(victim.folder / 'gone')
    assert row.bag_state().damage
    return True


FAULTS: tuple[Callable[[Victim], bool], ...] = (
    killed, terminated, stopped, full_disk, read_only, rotten_checkpoint, rotten_bag,
    cut_recording, planned_anew, another_plan, another_length, linked_run, lost_link,
)  # fmt: skip
