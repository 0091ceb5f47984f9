# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Rows trained one by one, as the jobs of a batch system do it."""

from __future__ import annotations

import signal
from pathlib import Path

import pandas as pd
import pytest
from hexapod_doe.bags.run_record import is_complete, read_run
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.progress import State

pytestmark = pytest.mark.system
STEPS = 40
MANAGER = (
    'ros2 run hexapod_doe manager_node --ros-args -p plan:=plan.csv -p episodes:=3 '
    '-p record_every:=2 -p config:={config} -p local_workers:=1'
)
CASE = (
    'ros2 run hexapod_doe run_case --plan plan.csv --row {row} --out jobs --episodes {episodes} '
    '--record-every {every} --config short.yaml'
)
PLAN = """\
StdOrder,RunOrder,case,replicate,seed,run_id,observations,A,B
1,2,1,1,11,r1,,-1,-1
2,1,2,1,12,r2,AB,1,1
"""


def case(row: int, episodes: int = 3, every: int = 2) -> str:
    return CASE.format(row=row, episodes=episodes, every=every)


@pytest.fixture
def plan(shell) -> Path:
    """Write a plan of two rows and the configuration that makes them short."""
    (shell.directory / 'plan.csv').write_text(PLAN)
    (shell.directory / 'short.yaml').write_text(
        f'task: {{time_limit_steps: {STEPS}}}\nddpg: {{batch_size: 16, update_every: 8}}\n'
        'training: {evaluation: 2}\n'
    )
    return shell.directory / 'plan.csv'


def results(bag: Path) -> pd.DataFrame:
    """Return what a run's episodes were, apart from when its worker's clock had them end."""
    run = read_run(bag)
    assert len(run.evaluation) == 2
    return pd.concat([run.episodes, run.evaluation]).drop(columns='stamp_ns')


def test_jobs_give_what_the_manager_gives(shell, plan: Path) -> None:
    jobs = [shell.start(case(row)) for row in (1, 2)]  # at once, on one host and domain
    ended = shell.run(MANAGER.format(config=shell.directory / 'short.yaml'), timeout_s=120.0)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert [job.wait(60.0) for job in jobs] == [0, 0], shell.output()
    for run_id in ('r1', 'r2'):
        job, managed = jobs_bag(shell, run_id), plan.parent / 'runs' / run_id
        pd.testing.assert_frame_equal(results(job), results(managed), check_exact=True)
        assert read_run(job).metadata['sampled_episodes'] == '1'
    assert '<title>2/2' in (shell.directory / 'jobs' / 'progress.html').read_text()
    assert_left_alone_at_once(shell)


def assert_left_alone_at_once(shell) -> None:
    before = jobs_bag(shell, 'r1').stat().st_mtime_ns
    again = shell.run(case(1), timeout_s=10.0)
    assert again.returncode == 0
    assert 'r1 is done' in again.stdout
    assert jobs_bag(shell, 'r1').stat().st_mtime_ns == before


def jobs_bag(shell, run_id: str) -> Path:
    return shell.directory / 'jobs' / 'runs' / run_id


def test_a_preempted_job_is_not_done_and_goes_on(shell, plan: Path) -> None:
    (shell.directory / 'short.yaml').write_text(
        f'task: {{time_limit_steps: {8 * STEPS}}}\nddpg: {{batch_size: 16, update_every: 8}}\n'
        'actor: {hidden: [16, 16]}\ncritic: {hidden: [16, 16]}\n'
        'training: {evaluation: 2}\n'
    )
    long = case(2, episodes=4, every=0)
    job = shell.start(long)
    directory = shell.directory / 'jobs'
    shell.until(lambda: plan_has_begun(directory))
    job.send_signal(signal.SIGSTOP)
    rival = shell.call(long)
    assert rival.returncode == 1
    assert 'is at it' in rival.stderr
    job.send_signal(signal.SIGTERM)
    job.send_signal(signal.SIGCONT)
    assert job.wait(30.0) == 1, shell.output()
    assert [run.run_id for run in read_progress(directory).having(State.INTERRUPTED)] == ['r2']
    assert 'the same command goes on' in shell.output()
    assert shell.run(long).returncode == 0
    assert is_complete(jobs_bag(shell, 'r2'))
    assert list(read_run(jobs_bag(shell, 'r2')).episodes.index) == list(range(4))


def plan_has_begun(directory: Path) -> bool:
    """Whether a row of a folder has an episode."""
    if not (directory / 'plan.csv').is_file():
        return False
    return any(run.returns for run in read_progress(directory).having(State.RUNNING))


@pytest.mark.parametrize(
    ('change', 'complaint'),
    [
        ('--row 3', 'no row 3, expected a StdOrder of 1 to 2'),
        ('--row 1 --plan nowhere.csv', 'nowhere.csv'),
    ],
)
def test_a_job_without_a_row_is_one_clear_line(shell, plan: Path, change, complaint) -> None:
    ended = shell.call(f'ros2 run hexapod_doe run_case --plan plan.csv {change}')
    assert ended.returncode == 2
    assert complaint in ended.stderr
    assert 'Traceback' not in ended.stderr


def test_a_folder_of_another_plan_is_refused(shell, plan: Path) -> None:
    out = shell.directory / 'jobs'
    out.mkdir()
    (out / 'plan.csv').write_text(plan.read_text().replace('r1', 'r9'))
    ended = shell.call(case(1))
    assert ended.returncode == 2
    assert 'another plan' in ended.stderr
