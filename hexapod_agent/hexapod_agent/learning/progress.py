# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How far a training is: a bar on a terminal, a line now and then into a file or a pipe."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from hexapod_agent.learning.metrics import SATURATED_SHARE
from hexapod_agent.learning.summary import EpisodeSummary


class Report(Protocol):
    """What tells of an episode."""

    def __call__(self, summary: EpisodeSummary, evaluation: int = 0) -> None:
        """Tell of one of the training, or of so many of the evaluation."""


_LINE_S = 30.0


@contextmanager
def episode_report(name: str, done: int, episodes: int) -> Iterator[Report]:
    """Yield what tells of an episode, as long as the context lasts.

    Args:
        name: Of the run.
        done: Episodes that it has had already.
        episodes: Its length.
    """
    console = Console()
    if not console.is_terminal:
        yield _lines(name, episodes)
        return
    progress = Progress(
        TextColumn('{task.description}'), BarColumn(), MofNCompleteColumn(),
        TimeRemainingColumn(), TextColumn('{task.fields[status]}'), console=console,
    )  # fmt: skip
    with progress:
        task = progress.add_task(name, total=episodes, completed=done, status='')

        def report(summary: EpisodeSummary, evaluation: int = 0) -> None:
            done = episodes if evaluation else summary.episode + 1
            progress.update(task, completed=done, status=_status(summary, evaluation))

        yield report


def _lines(name: str, episodes: int) -> Report:
    """Return what prints the first episode, the last one, and one every half minute."""
    due = 0.0

    def report(summary: EpisodeSummary, evaluation: int = 0) -> None:
        nonlocal due
        if time.monotonic() >= due or summary.episode + 1 == (evaluation or episodes):
            due = time.monotonic() + _LINE_S
            count = '' if evaluation else f'episode {summary.episode + 1} of {episodes}, '
            print(f'{name}: {count}{_status(summary, evaluation)}', flush=True)

    return report


def _status(summary: EpisodeSummary, evaluation: int) -> str:
    phase = f'evaluating, start {summary.episode + 1} of {evaluation}, ' if evaluation else ''
    return (
        f'{phase}return {summary.episode_return:.0f}, mean {summary.average_return:.0f}, '
        f'saturated {summary.metrics[SATURATED_SHARE]:.0%}'
    )
