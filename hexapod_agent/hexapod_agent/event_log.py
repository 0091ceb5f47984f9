# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Writes the learning curves of a run as TensorBoard event files."""

from __future__ import annotations

import math
from pathlib import Path
from types import TracebackType
from typing import Self

from tensorboardX import SummaryWriter

from hexapod_agent.summary import EpisodeSummary


class EventLog:
    """Event files of one run, a step per episode; close it, or use it as a context manager."""

    def __init__(self, directory: Path, first_episode: int = 0) -> None:
        """Open the log.

        Args:
            directory: Where the files go, for `tensorboard --logdir`.
            first_episode: Where the run begins or goes on; what files in the directory hold from
                there on is not shown any more.
        """
        # Names hold the second only: the suffix keeps a quick resumption from overwriting.
        self._writer = SummaryWriter(
            str(directory), purge_step=first_episode, filename_suffix=f'.{first_episode}'
        )

    def add(self, summary: EpisodeSummary) -> None:
        """Write the curves' points of one episode; what is not known yet is left out."""
        for tag, value in scalars(summary).items():
            if math.isfinite(value):
                self._writer.add_scalar(tag, value, summary.episode)
        self._writer.flush()

    def close(self) -> None:
        """Write what is left."""
        self._writer.close()

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
        'learner/critic_loss': summary.critic_loss,
        'learner/actor_loss': summary.actor_loss,
        'learner/mean_q': summary.mean_q,
        'learner/saturated_share': summary.saturated_share,
        'learner/updates': summary.updates,
        **{f'term/{name}': value for name, value in summary.terms.items()},
    }
