# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A hostile peer ends no node, and neither changes nor learns what lies outside the campaign.

`HEXAPOD_FUZZ_SEED` and `HEXAPOD_FUZZ_SHARE`, of the great run, say by which seed and how long.
"""

from __future__ import annotations

import hashlib
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from hexapod_interfaces.action import TrainRun

from .hostile import Hostile

pytestmark = pytest.mark.system
ROOT = Path(__file__).resolve().parents[2]
SEED = int(os.environ.get('HEXAPOD_FUZZ_SEED', '7'))
SHARE = float(os.environ.get('HEXAPOD_FUZZ_SHARE', '1'))
SECRET = 'swordfish'
SHORT = 'task: {time_limit_steps: 200}\nddpg: {update_every: 50}\ntraining: {evaluation: 1}\n'
GOOD = SHORT.replace('{evaluation', '{episodes: 5, evaluation') + 'observations: ABCDEFG\n'
AGENT = ROOT / 'ros_ws/src/hexapod_bringup/agents/ABCDE.pt'

# Messages, requests, parameter sets, and in how many turns.
SOME = (1_500, 150, 150, 3)
ALL = (int(100_000 * SHARE), int(10_000 * SHARE), int(10_000 * SHARE), 20)
FEW_NODES = {
    'worker': 'ros2 run hexapod_bringup worker_node --ros-args -r __ns:=/w -p root:=campaign/runs '
    '-p match_timeout:=0.2 -p drain_timeout:=0.2 -p result_timeout:=0.2',
    'player': 'ros2 run hexapod_doe player_node --ros-args -r __ns:=/p -p loop:=true '
    f'-p bag:={ROOT}/bags/sample',
    'fake driver': 'ros2 run hexapod_sim fake_driver --ros-args -r __ns:=/w -p delay:=0.05',
}
ALL_NODES = FEW_NODES | {
    'manager': 'ros2 run hexapod_doe manager_node --ros-args -p plan:=campaign/plan.csv '
    '-p local_workers:=0 -p worker_timeout:=86400.0 -p attempts:=100 -p config:=short.yaml '
    '-p stall_timeout:=20.0',
    'description': 'ros2 run hexapod_bringup description_node --ros-args -r __ns:=/w',
    'robot': 'ros2 run hexapod_sim sim_node --ros-args -r __ns:=/r -p sync:=realtime',
    'robot cpg': 'ros2 run hexapod_cpg cpg_node --ros-args -r __ns:=/r -p sync:=realtime',
    'robot play': 'ros2 run hexapod_agent play_node --ros-args -r __ns:=/r -p sync:=realtime '
    f'-p checkpoint:={AGENT} -p check_seconds:=0.0',
}


def picture(folder: Path) -> dict[str, str]:
    """Return a fingerprint of every file below a folder, by name."""
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        if path.is_file()
        else 'folder'
        for path in sorted(folder.rglob('*'))
    }


@pytest.fixture
def outside(tmp_path_factory, monkeypatch) -> Path:
    """Return what lies outside of the campaign: the home folder, and files with a secret."""
    folder = tmp_path_factory.mktemp('outside')
    (folder / 'home').mkdir()
    for name in ('secret.yaml', 'home/secret.yaml', 'agent.pt'):
        (folder / name).write_text(f'{SECRET}: {{{SECRET}: [{SECRET}\n')
    monkeypatch.setenv('HOME', str(folder / 'home'))
    return folder


def paths(shell, outside: Path) -> list[str]:
    """Return what a peer may try to name."""
    here = shell.directory
    runs = here / 'campaign' / 'runs'
    away = (
        'secret.yaml', 'agent.pt', 'new/bag', 'home/.bashrc', 'home', 'a' * 300, 'a' * 250,
    )  # fmt: skip
    return [
        *(str(outside / name) for name in away),
        *(f'{runs}/x{n}' for n in range(4)),
        *(str(runs / name) for name in ('..', '.', 'link/bag', 'a' * 250, 'x0.pt')),
        f'{runs}/../../made', f'{runs}/{os.path.relpath(outside, runs)}/secret.yaml',
        str(here / 'short.yaml'), str(here / 'campaign' / 'plan.csv'), str(here / 'output_0'),
        '~/secret.yaml', '~root/x', '/etc/passwd', '/proc/self/environ', '/dev/zero', 'made', '',
    ]  # fmt: skip


@pytest.mark.parametrize(
    ('lines', 'counts'),
    [(FEW_NODES, SOME), pytest.param(ALL_NODES, ALL, marks=pytest.mark.slow)],
    ids=['some', 'all'],
)
@pytest.mark.timeout(7200)
def test_nothing_that_a_peer_sends_ends_a_node_or_leads_out(
    shell, own_domain: int, outside: Path, lines: dict[str, str], counts: tuple[int, int, int, int]
) -> None:
    here = shell.directory
    (here / 'short.yaml').write_text(SHORT)
    made = shell.call(
        'ros2 run hexapod_doe plan --design quarter --seed 1 --out campaign/plan.csv'
    )
    assert made.returncode == 0, made.stderr
    (here / 'campaign' / 'runs').mkdir()
    (here / 'campaign' / 'runs' / 'link').symlink_to(outside)
    before = picture(outside)
    processes = {name: shell.start(line) for name, line in lines.items()}

    def alive() -> None:
        ended = {n: p.returncode for n, p in processes.items() if p.poll() is not None}
        assert not ended, (ended, shell.output()[-4000:])

    peer = Hostile(own_domain, SEED, paths(shell, outside), SECRET)
    try:
        wanted = len(lines) + 3
        shell.until(lambda: peer.spin(0.1) or len(peer.nodes()) >= wanted, 120.0)
        nodes = peer.nodes()
        assert all(peer.answers(node) for node in nodes)
        # In turns, as a peer would: what one changes, the next one meets.
        turns = counts[3]
        for turn in range(turns):
            runs = here / 'campaign' / 'runs'
            goal = TrainRun.Goal(run_id=f'good{turn}', spec=GOOD, seed=turn)
            goal.bag, goal.record_every = f'{runs}/good{turn}', 1
            peer.begin_run('/w/train_run', goal)
            peer.send_messages(counts[0] // turns, alive)
            peer.send_requests(counts[1] // turns, alive)
            peer.set_parameters(counts[2] // turns, alive)
            peer.settle()
            print(f'turn {turn}: {peer.tally()}', flush=True)
        print(f'unanswered: {dict(peer.unanswered())}', flush=True)
        assert [node for node in nodes if not peer.answers(node)] == []
        alive()
        assert sum(peer.sent.values()) == counts[0] // turns * turns
        assert {'/w/joint_states', '/w/foot_force/lf', '/w/cpg/command'} <= set(peer.sent)
        assert peer.quoted == []
        assert peer.answered > 0.9 * sum(peer.asked.values())
    finally:
        peer.close()
    for process in processes.values():
        process.send_signal(signal.SIGINT)
    ended = {name: wait(process) for name, process in processes.items()}
    assert ended == dict.fromkeys(processes, 0), shell.output()[-4000:]
    assert 'Traceback' not in shell.output()
    assert picture(outside) == before
    names = {path.name for path in here.iterdir()}
    assert names <= {'short.yaml', 'campaign', *(f'output_{n}' for n in range(20))}, names


def wait(process: subprocess.Popen[str]) -> int | None:
    """Return the exit status, or None where it does not end."""
    end = time.monotonic() + 60.0
    while process.poll() is None and time.monotonic() < end:
        time.sleep(0.1)
    return process.returncode
