# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Throughput of a campaign with one local worker and with two: learner, bags and manager included.

Run: `python tests/benchmarks/bench_campaign.py`. The time is from the first bag's beginning to the
last bag's end, so that starting workers does not count, but everything between two runs does:
more than in a campaign of the article's, whose runs are 160 times as long.
What two processes that do nothing but learn reach, sharing caches and memory, is the bound.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import torch
from hexapod_agent.algorithms.replay import Batch
from hexapod_agent.learning.numerics import set_numerics
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_cpg.mapping import ACTION_SIZE
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.progress import State
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

ROWS, EPISODES = 4, 6
TARGET = 1.8
LEARN_S = 10.0
DOMAIN = '97'
PLAN = 'ros2 run hexapod_doe plan --design eighth --replicates 1 --seed 1 --out {plan}'
MANAGER = (
    'ros2 run hexapod_doe manager_node --ros-args -p plan:={plan} -p episodes:={episodes} '
    '-p record_every:=0 -p local_workers:={workers} -p set:=[training.evaluation=0]'
)


def make_plan(directory: Path) -> Path:
    """Write a plan of a few rows of the article's eighth fraction."""
    plan = directory / 'plan.csv'
    subprocess.run(PLAN.format(plan=plan).split(), check=True, stdout=subprocess.DEVNULL)
    header, *rows = plan.read_text().splitlines()
    order = header.split(',').index('RunOrder')
    first = [row for row in rows if int(row.split(',')[order]) <= ROWS]
    plan.write_text('\n'.join([header, *first]) + '\n')
    return plan


def episodes_per_second(directory: Path, workers: int) -> float:
    """Run the campaign and return its throughput."""
    line = MANAGER.format(plan=make_plan(directory), episodes=EPISODES, workers=workers)
    manager = subprocess.Popen(line.split(), stdout=subprocess.DEVNULL)
    began = None
    while manager.poll() is None:
        if began is None and any((directory / 'runs').glob('*.partial')):
            began = time.time()
        time.sleep(0.02)
    assert manager.returncode == 0, f'the campaign ended with status {manager.returncode}'
    assert len(read_progress(directory).having(State.DONE)) == ROWS
    ended = max(file.stat().st_mtime for file in directory.glob('runs/*/metadata.yaml'))
    return ROWS * EPISODES / (ended - began)


def learn() -> None:
    """Print how many updates a second one learner makes."""
    config = RunSpec.load().observing('ABCDE')
    set_numerics(config.training.precision)
    networks = Trainer(config, 1).learner.networks
    sizes = (config.learner.ddpg.batch_size, config.observed.size, ACTION_SIZE)
    batch = Batch.empty(1, *sizes, torch.float32).inner(0)
    for tensor in vars(batch).values():
        tensor.uniform_(-1.0, 1.0)
    updates, began = 0, time.perf_counter()
    while time.perf_counter() - began < LEARN_S:
        networks.update(batch)
        updates += 1
    print(updates / LEARN_S)


def updates_per_second(processes: int) -> float:
    """Return the updates of learners side by side, each in a process of its own."""
    command = [sys.executable, __file__, 'learn']
    running = [
        subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(processes)
    ]
    return sum(float(process.communicate()[0]) for process in running)


def main() -> None:
    """Print both rates and their ratio, and the ratio of the learners alone."""
    os.environ['ROS_DOMAIN_ID'] = DOMAIN
    os.environ['OMP_NUM_THREADS'] = '1'
    rates, bound = {}, {}
    with Progress(transient=True) as progress:
        for workers in progress.track((1, 2), description='campaigns'):
            bound[workers] = updates_per_second(workers)
            with tempfile.TemporaryDirectory() as name:
                rates[workers] = episodes_per_second(Path(name), workers)
    table = Table('local workers', 'episodes/s', 'times one worker', 'learners alone', 'target')
    table.add_row('1', f'{rates[1]:.2f}', '', '', '')
    ratios = (f'{rates[2] / rates[1]:.2f}', f'{bound[2] / bound[1]:.2f}')
    table.add_row('2', f'{rates[2]:.2f}', *ratios, f'{TARGET}')
    Console().print(table)


if __name__ == '__main__':
    learn() if sys.argv[1:] == ['learn'] else main()
