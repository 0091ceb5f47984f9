# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Writes the learning curves of a run as TensorBoard event files."""

import math
import time
from collections.abc import Iterable
from pathlib import Path
from types import TracebackType
from typing import Self

from hexapod_agent.compat import Event, EventsWriter, SessionLog, scalar
from hexapod_agent.learning.summary import EpisodeSummary


class EventLog:
    """Event files of one run, a step per episode; close it, or use it as a context manager."""

    def __init__(self, directory: Path, first_episode: int = 0) -> None:
        """Open the log.

        Args:
            directory: Where the files go, for `tensorboard --logdir`.
            first_episode: Where the run begins or goes on; what files in the directory hold from
                there on is not shown any more.
        """
        directory.mkdir(parents=True, exist_ok=True)
        self._directory = directory
        self._broken = False
        # Names hold the second only: the suffix keeps a quick resumption from overwriting. Not a
        # SummaryWriter: its thread dies of a full disk, and then whoever writes waits for ever.
        self._writer = EventsWriter(str(directory / 'events'), f'.{first_episode}')
        start = SessionLog(status=SessionLog.START)
        self._write([Event(step=first_episode, session_log=start)])

    def add(self, summary: EpisodeSummary) -> None:
        """Write the curves' points of one episode; what is not known yet is left out.

        Raises:
            OSError: the disk refuses.
        """
        self._write(
            Event(step=summary.episode, wall_time=time.time(), summary=scalar(tag, value))
            for tag, value in scalars(summary).items()
            if math.isfinite(value)
        )

    def close(self) -> None:
        """Close the file, with every point in it unless the disk has refused one."""
        if not self._broken:
            self._writer.close()

    def _write(self, events: Iterable[Event]) -> None:
        try:
            for event in events:
                self._writer.write_event(event)
            self._writer.flush()
        except OSError as error:
            self._broken = True
            raise OSError(error.errno, error.strerror, str(self._directory)) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def scalars(summary: EpisodeSummary) -> dict[str, float]:
    """Return the points of an episode by tag; the part before the slash groups the charts."""
    return {
        'return/episode': summary.episode_return,
        'return/average': summary.average_return,
        'episode/steps': summary.steps,
        'episode/terminated': float(summary.terminated),
        **{f'learner/{name}': value for name, value in summary.metrics.items()},
        **{f'term/{name}': value for name, value in summary.terms.items()},
    }
