# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A row of the plan as a run of a fleet: its bag, its checkpoints, and going on from them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Protocol

from hexapod_agent.deployment.agent_file import CheckpointError
from hexapod_agent.learning import checkpoint, run_checkpoint
from hexapod_agent.learning.event_log import EventLog
from hexapod_agent.learning.provenance import provenance
from hexapod_agent.learning.summary import EpisodeSummary
from hexapod_agent.learning.training import Trainer
from hexapod_sim.robot import CONTROL_PERIOD_NS

from hexapod_doe.bags.carry_over import carry_over, find_cut
from hexapod_doe.bags.episode_result import serialise
from hexapod_doe.bags.recording import Recording
from hexapod_doe.bags.rosbag2 import OfferedQos, Topic
from hexapod_doe.bags.run_bag import (
    EPISODE_RESULT,
    EVALUATION,
    EVALUATION_RETURN,
    EVALUATION_TOPIC,
    RESULT_TOPIC,
    RESUMED,
)
from hexapod_doe.bags.salvage import set_aside
from hexapod_doe.campaigns.row import Row

# The profile that the graph's agent offers.
_RESULTS, _EVALUATION = (
    Topic(f'/fleet/{name}', EPISODE_RESULT, (OfferedQos(depth=1000),))
    for name in (RESULT_TOPIC, EVALUATION_TOPIC)
)


class Watch(Protocol):
    """Who follows the rows."""

    def log(self, text: str) -> None:
        """Take note of something unusual."""

    def episode(self, row: Row, summary: EpisodeSummary) -> None:
        """Take note of an episode."""

    def end(self, row: Row, error: Exception | None) -> None:
        """Take note that a row has ended, by an error if there is one."""


class FleetRow:
    """One row while it is trained.

    Results go into the bag as episodes end. At a checkpoint the disk has them before it has the
    checkpoint: after a crash the run goes on from there, its bag from the episodes before.

    Attributes:
        row: of the plan.
        trainer: the run.
        episodes: how many it is to have.
    """

    def __init__(self, row: Row, device: str, watch: Watch) -> None:
        """Begin the row, or go on where an earlier process left it.

        Raises:
            BagError: the bag cannot be written, or is being written by somebody else.
        """
        self.row, self.episodes, self._watch = row, row.spec.training.episodes, watch
        set_aside(row.bag)
        metadata = _metadata(row, device)
        self.trainer, cut = self._begin(metadata)
        done = self.trainer.episode
        if cut is not None:
            metadata[RESUMED] = str(done)
        self._recording = Recording(row.run_id, row.bag, metadata, CONTROL_PERIOD_NS)
        self._last_ns = 0
        self._found: dict[str, str] = {}
        if cut is None:
            self._recording.forget_cuts()
        else:
            self._last_ns = carry_over(self._recording, cut, done, _RESULTS.name)
        self._events = EventLog(Path(f'{row.bag}.tensorboard'), done)

    def _begin(self, metadata: Mapping[str, str]) -> tuple[Trainer, Path | None]:
        """Return the row's trainer and, where it goes on, the bag with the episodes it has had."""
        row = self.row
        try:
            trainer = run_checkpoint.resumed(row.bag, row.spec, row.seed)
        except CheckpointError as error:
            self._watch.log(f'run {row.run_id} begins anew: {error}')
            trainer = None
        if trainer is not None:
            cut = find_cut(row.bag, row.run_id, trainer.episode, metadata)
            if cut is not None:
                return trainer, cut
            self._watch.log(
                f'run {row.run_id} begins anew: no recording holds the {trainer.episode} episodes '
                'before its checkpoint'
            )
        return Trainer(row.spec, row.seed), None

    @property
    def saves_next(self) -> bool:
        """Whether the trainer is saved after the episode that is under way."""
        return self._is_checkpoint(self.trainer.episode + 1)

    def _is_checkpoint(self, episode: int) -> bool:
        return episode % self.trainer.config.training.checkpoint_every == 0

    def episode_ended(self, summary: EpisodeSummary) -> None:
        """Record the episode, and take a checkpoint where one is due.

        Raises:
            BagError: the disk refuses.
            hexapod_agent.deployment.agent_file.CheckpointError: likewise.
        """
        self._record(_RESULTS, summary)
        self._events.add(summary)
        episode = self.trainer.episode
        if self._is_checkpoint(episode) and episode < self.episodes:
            self._recording.secure()
            run_checkpoint.keep(self.row.bag, self.trainer)
        self._watch.episode(self.row, summary)

    def evaluated(self, summary: EpisodeSummary) -> None:
        """Record an episode of the evaluation.

        Raises:
            BagError: the disk refuses.
        """
        self._record(_EVALUATION, summary)
        self._found = {EVALUATION_RETURN: repr(summary.average_return)}  # of those so far

    def _record(self, topic: Topic, summary: EpisodeSummary) -> None:
        # The start of an episode is a period after the end of the one before.
        self._last_ns += (summary.steps + 1) * CONTROL_PERIOD_NS
        data = serialise(self.row.run_id, summary, self._last_ns)
        self._recording.add_result(topic, data, summary.episode, summary.steps)

    def ended(self) -> None:
        """Save the agent, close the bag, and forget the checkpoint.

        Raises:
            BagError: the disk refuses.
        """
        agent = Path(f'{self.row.bag}.pt')
        checkpoint.save_agent(agent, self.trainer)
        self._recording.finish(self.episodes, {'checkpoint': agent.name} | self._found)
        run_checkpoint.forget(self.row.bag)
        self._events.close()
        self._watch.end(self.row, None)

    def failed(self, error: Exception) -> None:
        """Leave the bag readable, under its unfinished name."""
        self._recording.abandon()
        self._events.close()
        self._watch.end(self.row, error)


def _metadata(row: Row, device: str) -> dict[str, str]:
    """Return what the bag says of the run: as the graph's does, but that no topic was needed."""
    return {
        **row.metadata,
        'observations': row.spec.letters,
        'seed': str(row.seed),
        'mode': 'train',
        'episodes': str(row.spec.training.episodes),
        'window': str(row.spec.training.window),
        EVALUATION: str(row.spec.training.evaluation),
        'spec': row.spec.to_text(),
        'subscriptions': '',
        'device': device,
        **provenance(),
    }
