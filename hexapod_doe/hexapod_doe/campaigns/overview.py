# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Draws a campaign's progress for the terminal: figures, workers, learning curves."""

import math
from collections.abc import Iterable

from rich.console import Group, RenderableType
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from hexapod_doe.campaigns.curves import limits, sparkline, thin
from hexapod_doe.campaigns.progress import OPEN, Progress, Run, State, duration

_POINTS = 24
_STYLES = {
    State.DONE: 'green',
    State.RUNNING: 'cyan',
    State.INTERRUPTED: 'yellow',
    State.FAILED: 'red',
    State.OTHER: 'red',
    State.DAMAGED: 'red',
    State.DUE: 'dim',
}


def overview(progress: Progress, runs: Iterable[Run]) -> RenderableType:
    """Return everything: the figures, the workers, and a line for each of some runs."""
    legend = [Text(line) for line in progress.legend]
    tables = (figures(progress), '', _workers(progress), '', *legend, _runs(progress, runs))
    return Group(*tables, _failures(progress))


def summary(progress: Progress) -> str:
    """Return how many runs are in each state, and the pace."""
    counts = {state: len(progress.having(state)) for state in State}
    parts = [f'{len(progress.runs)} runs: {counts[State.DONE]} done']
    parts += [f'{n} {state}' for state, n in counts.items() if n and state is not State.DONE]
    end = progress.stopped if progress.complete else ''
    return f'{", ".join(parts)}; {end or pace(progress)}'


def pace(progress: Progress) -> str:
    """Return the rate and the time that is left."""
    rate = progress.episodes_per_second
    if rate == 0.0 and progress.having(*OPEN):
        at_work = progress.having(State.RUNNING)
        return 'no episode has ended yet' if at_work else 'nobody is at work'
    return f'{rate:.2f} episodes/s, {duration(progress.seconds_left)} left'


def figures(progress: Progress) -> RenderableType:
    """Return a bar of the episodes above the summary."""
    table = Table.grid(padding=(0, 1))
    table.add_row(
        Text(progress.name, style='bold'),
        ProgressBar(total=progress.planned or 1, completed=progress.episodes, width=32),
        f'{progress.episodes}/{progress.planned or "?"} episodes',
    )
    return Group(table, summary(progress), *(Text(line) for line in measured(progress)))


def measured(progress: Progress) -> list[str]:
    """Return a line of what finished runs took, and what is left at that pace; [] without one."""
    if not progress.measured:
        return []
    pace, left = progress.runs_per_core_hour, progress.core_hours_left
    line = f'{len(progress.measured)} runs measured: {pace:.1f} per core-hour'
    if left:
        line += f'; {left:.1f} core-hours left'
    if side := len(progress.having(State.RUNNING)):
        line += f', {left / side:.1f} h with {side} at a time'
    return [line]


def _workers(progress: Progress) -> RenderableType:
    table = Table('worker', 'runs done', 'episodes/s', 'at work on', box=None, pad_edge=False)
    for worker in progress.workers:
        now = [f'{run.run_id} {len(run.returns)}/{run.planned or "?"}' for run in worker.runs]
        rate = f'{worker.episodes_per_second:.2f}'
        table.add_row(worker.name, str(worker.done), rate, ', '.join(now))
    return table if table.row_count else Text('no worker yet')


def _runs(progress: Progress, runs: Iterable[Run]) -> RenderableType:
    curves = {name: thin(run.returns, _POINTS) for name, run in progress.runs.items()}
    low, high = limits(curves.values())
    curve_title = f'returns, {low:.0f} to {high:.0f}'
    table = Table(
        'run',
        progress.heading,
        'state',
        'episodes',
        curve_title,
        'reward',
        box=None,
        pad_edge=False,
    )
    for run in runs:
        reward = '' if math.isnan(run.reward) else f'{run.reward:.1f}'
        table.add_row(
            run.run_id,
            run.label,
            Text(run.phase, style=_STYLES[run.state]),
            f'{len(run.returns)}/{run.planned}' if run.planned else '',
            sparkline(curves[run.run_id], low, high),
            reward,
        )
    return table


def _failures(progress: Progress) -> RenderableType:
    lines = [f'{r.run_id} failed: {r.reason}' for r in progress.having(State.FAILED)]
    lines += [
        f'{r.run_id} has the bag of another run: {r.reason}' for r in progress.having(State.OTHER)
    ]
    lines += [f'{r.run_id} is damaged: {r.reason}' for r in progress.having(State.DAMAGED)]
    lines += [f'runs are not alike: {text}' for text in progress.mixed]
    return Group('', *map(Text, lines)) if lines else Group()
