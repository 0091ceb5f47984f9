# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A fleet's speed: against a run alone, processes and workers on the same cores; and by part.

Run: `python tests/benchmarks/bench_fleet.py`. All run the configuration of article.yaml with
two episodes of 144 steps, whole groups of updates. The first, without a full batch, is not timed.
Each is timed in turn, for several rounds; the best round counts, as other load only ever slows
down. On a busy machine the processor time of a step is the figure to compare.

With an accelerator, `--device cuda` times fleets of 1, 32 and 320 rows on it instead, the last
also in several processes.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import shlex
import signal
import subprocess
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import yaml
from bench_graph import Client
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.fleet.fleet import Stopwatch
from hexapod_agent.fleet.pool import Pool
from hexapod_agent.learning.summary import EpisodeSummary
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.specification.spec_text import changes_text
from hexapod_agent.train import train_episode
from hexapod_doe.run_fleet import build_fleet
from hexapod_interfaces.action import TrainRun
from rclpy.action import ActionClient
from rich.console import Console
from rich.table import Table

CORES = os.cpu_count() or 1
OBSERVATIONS = 'ABCDE'
STEPS, EPISODES, ROUNDS = 144, 2, 3
ROWS = {'cpu': (1, 4, 32)}
ROWS_ON_DEVICE = (1, 32, 320)
PROCESSES_ON_DEVICE = 8  # for the most rows, once more
CHANGES = {
    'task': {'time_limit_steps': STEPS},
    'ddpg': {'buffer_size': 10_000},
    'training': {'evaluation': 0},
}
RUN_STEPS = 1000 * 600  # of a run of the article's length
CAMPAIGN_RUNS = 320


@dataclass(frozen=True)
class Speed:
    """What so many steps took."""

    steps: int
    wall_s: float
    cpu_s: float

    @property
    def rate(self) -> float:
        """Steps per second."""
        return self.steps / self.wall_s

    @property
    def cost_ms(self) -> float:
        """Processor time of a step."""
        return 1e3 * self.cpu_s / self.steps

    @staticmethod
    def together(speeds: Sequence[Speed]) -> Speed:
        """Speed of several that ran at once."""
        rate = sum(speed.rate for speed in speeds)
        steps = sum(speed.steps for speed in speeds)
        return Speed(steps, steps / rate, sum(speed.cpu_s for speed in speeds))


def new_trainer(seed: int) -> Trainer:
    """A run that has yet to begin."""
    config = RunSpec.from_mapping(CHANGES, 'bench_fleet')
    return Trainer(config.observing(OBSERVATIONS), seed)


def one_run(seed: int = 1) -> Speed:
    """A run alone in the Gymnasium environment."""
    trainer = new_trainer(seed)
    env = HexapodLine(OBSERVATIONS, trainer.config)
    train_episode(env, trainer)
    wall, cpu = time.perf_counter(), time.process_time()
    train_episode(env, trainer)
    return Speed(STEPS, time.perf_counter() - wall, time.process_time() - cpu)


def processes(one: Callable[[int], Speed], count: int = CORES) -> Speed:
    """The same in several processes, all at once; one per core."""
    with multiprocessing.get_context('spawn').Pool(count) as pool:
        return Speed.together(pool.map(one, range(count), chunksize=1))


def session_cpu_s(session: int) -> float:
    """Processor time so far of all processes of a session."""
    ticks = 0
    for stat in Path('/proc').glob('[0-9]*/stat'):
        try:
            fields = stat.read_text().rpartition(')')[2].split()
        except ProcessLookupError:  # it ended just now
            continue
        if int(fields[3]) == session:
            ticks += int(fields[11]) + int(fields[12])  # in user and in system mode
    return ticks / os.sysconf('SC_CLK_TCK')


class Workers:
    """Composed workers on the graph, one per core, as a campaign has them."""

    def __init__(self, config: Path) -> None:
        command = 'ros2 launch hexapod_bringup worker.launch.xml composed:=true namespace:='
        self._config = str(config)
        self._launched = [
            subprocess.Popen(
                shlex.split(f'{command}bench_{n}'),
                stdout=subprocess.DEVNULL,
                start_new_session=True,
            )
            for n in range(CORES)
        ]
        self._client = client = Client()
        self._clients = [
            ActionClient(client.node, TrainRun, f'/bench_{n}/train_run') for n in range(CORES)
        ]
        for each in self._clients:
            client.warm_up(each, self._goal(episodes=1))

    def _goal(self, episodes: int) -> TrainRun.Goal:
        settings = [f'observations={OBSERVATIONS}', f'training.episodes={episodes}']
        spec = changes_text(self._config, settings)
        return TrainRun.Goal(run_id='bench', spec=spec, seed=1)

    def speed(self) -> Speed:
        """Give each worker a run at once; count from the end of its first episode."""
        ended: defaultdict[int, list[tuple[float, float]]] = defaultdict(list)

        def on_feedback(worker: int, message: TrainRun.Impl.FeedbackMessage) -> None:
            if message.feedback.ended:
                cpu_s = session_cpu_s(self._launched[worker].pid)
                ended[worker].append((time.perf_counter(), cpu_s))

        goal = self._goal(EPISODES)
        sent = [
            each.send_goal_async(goal, feedback_callback=partial(on_feedback, worker))
            for worker, each in enumerate(self._clients)
        ]
        results = [self._client.result(future).get_result_async() for future in sent]
        for future in results:
            message = self._client.result(future).result.message
            assert message == '', message
        return Speed.together(
            [Speed(STEPS, end[0] - begin[0], end[1] - begin[1]) for begin, end in ended.values()]
        )

    def close(self) -> None:
        """End the workers."""
        for process in self._launched:
            process.send_signal(signal.SIGINT)
        for process in self._launched:
            process.wait(20.0)


class TimedRun:
    """A run in a fleet; the end of its first episode starts the clock."""

    saves_next = False
    episodes = EPISODES

    def __init__(self, seed: int, start_clock: Callable[[], None]) -> None:
        self.trainer = new_trainer(seed)
        self._start_clock = start_clock

    def episode_ended(self, summary: EpisodeSummary) -> None:
        """Start the clock, again with each further run: they end their episodes together."""
        if summary.episode == 0:
            self._start_clock()

    def ended(self) -> None:
        """Nothing to keep."""

    def failed(self, error: Exception) -> None:
        """A run that does not learn must not be timed."""
        raise error


def one_fleet(seed: int) -> Speed:
    """One of the processes of `run_fleet`."""
    return fleet(1)[0]


def share_of_fleet(rows: int, device: str, threads: int, number: int) -> Speed:
    """One of the processes of `run_fleet` on a device."""
    return fleet(rows, device, threads)[0]


def fleet(
    rows: int, device: str = 'cpu', threads: int | None = None
) -> tuple[Speed, dict[str, float]]:
    """A fleet of so many rows at a time in this process; with the shares of its time."""
    wall = cpu = 0.0

    def start_clock() -> None:
        nonlocal wall, cpu
        wall, cpu = time.perf_counter(), time.process_time()
        made.stopwatch = Stopwatch()

    with Pool(threads or (1 if device == 'cpu' else CORES)) as pool:
        runs = [TimedRun(seed, start_clock) for seed in range(rows)]
        made = build_fleet([runs[0].trainer.config], rows, pool, device)
        made.train(partial(next, iter(runs), None))
        speed = Speed(rows * STEPS, time.perf_counter() - wall, time.process_time() - cpu)
        return speed, made.stopwatch.shares()


def against_others(console: Console) -> None:
    """Print how many runs an hour each way of training makes."""
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / 'bench.yaml'
        path.write_text(yaml.safe_dump(CHANGES))
        workers = Workers(path)
        ways: dict[str, Callable[[], Speed]] = {
            'one run after another': one_run,
            f'{CORES} processes': partial(processes, one_run),
            f'{CORES} workers on the graph': workers.speed,
            'run_fleet': partial(processes, one_fleet),
        }
        rounds = [{name: way() for name, way in ways.items()} for _ in range(ROUNDS)]
        workers.close()
    rates = {name: max(each[name].rate for each in rounds) for name in ways}
    costs = {name: min(each[name].cost_ms for each in rounds) for name in ways}
    table = Table(
        f'{CORES} cores', 'steps/s', 'runs/hour', 'fleet is', 'cpu ms/step', 'fleet takes'
    )
    best = rates['run_fleet'], costs['run_fleet']
    for name, rate in rates.items():
        table.add_row(
            name, f'{rate:.0f}', f'{rate * 3600 / RUN_STEPS:.2f}', f'{best[0] / rate:.2f} x',
            f'{costs[name]:.2f}', f'{best[1] / costs[name]:.2f} x',
        )  # fmt: skip
    console.print(table)


def by_part(console: Console, device: str) -> None:
    """Print the speed of a fleet by its size, where its time goes, and what a campaign takes."""
    measured = {str(rows): fleet(rows, device) for rows in ROWS.get(device, ROWS_ON_DEVICE)}
    parts = next(iter(measured.values()))[1]
    if device not in ROWS:
        count, rows = PROCESSES_ON_DEVICE, ROWS_ON_DEVICE[-1]
        one = partial(share_of_fleet, rows // count, device, max(CORES // count, 1))
        measured[f'{rows} in {count} processes'] = processes(one, count), {}
    hours = f'hours for {CAMPAIGN_RUNS} runs'
    table = Table('rows at a time', 'agent steps/s', 'cpu ms/step', *parts, hours)
    for rows, (speed, shares) in measured.items():
        percent = (f'{shares[name]:.1%}' if shares else '' for name in parts)
        campaign = CAMPAIGN_RUNS * RUN_STEPS / speed.rate / 3600
        figures = (f'{speed.rate:.0f}', f'{speed.cost_ms:.2f}')
        table.add_row(rows, *figures, *percent, f'{campaign:.1f}')
    console.print(table)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--device', default='cpu', help='where the networks are')
    device = parser.parse_args().device
    os.environ.setdefault('OMP_NUM_THREADS', '1')
    console = Console(width=120)
    if device == 'cpu':
        against_others(console)
    by_part(console, device)


if __name__ == '__main__':
    main()
