# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A row of the plan as a run of a fleet: its bag, its checkpoints, and going on from them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import yaml
from hexapod_agent.config import AgentConfig
from hexapod_agent.event_log import EventLog
from hexapod_agent.observation import ObservationSpec
from hexapod_agent.provenance import provenance
from hexapod_agent.summary import EpisodeSummary
from hexapod_agent.training import Trainer
from hexapod_sim.robot import CONTROL_PERIOD_NS

from hexapod_agent import checkpoint
from hexapod_doe.bags.carry_over import carry_over, find_cut
from hexapod_doe.bags.episode_result import serialise
from hexapod_doe.bags.recording import Recording
from hexapod_doe.bags.rosbag2 import OfferedQos, Topic
from hexapod_doe.bags.run_bag import EPISODE_RESULT, RESUMED
from hexapod_doe.bags.salvage import set_aside
from hexapod_doe.campaigns.campaign import Row
from hexapod_doe.errors import BagError

# The profile that the graph's agent offers.
_RESULTS = Topic('/fleet/episode_result', EPISODE_RESULT, (OfferedQos(depth=1000),))

EpisodeListener = Callable[[Row, EpisodeSummary], None]
EndListener = Callable[[Row, Exception | None], None]


class FleetRow:
    """One row while it is trained.

    Results go into the bag as episodes end. At a checkpoint the disk has them before it has the
    checkpoint: after a crash the run goes on from there, its bag from the episodes before.

    Attributes:
        row: of the plan.
        trainer: the run.
        episodes: how many it is to have.
    """

    def __init__(
        self,
        row: Row,
        config: AgentConfig,
        episodes: int,
        device: str,
        on_episode: EpisodeListener,
        on_end: EndListener,
    ) -> None:
        """Begin the row, or go on where an earlier process left it.

        Raises:
            BagError: the bag cannot be written, or is being written by somebody else; or the
                checkpoint is of another configuration.
            hexapod_agent.checkpoint.CheckpointError: it cannot be read.
        """
        self.row, self.episodes = row, episodes
        self._on_episode, self._on_end = on_episode, on_end
        self._checkpoint = checkpoint_path(row.bag)
        set_aside(row.bag)
        self.trainer, cut = _resumed(row, config)
        metadata = _metadata(row, config, episodes, device)
        if cut is not None:
            metadata |= {RESUMED: str(self.trainer.episode)}
        self._recording = Recording(row.run_id, row.bag, metadata, CONTROL_PERIOD_NS)
        self._last_ns = 0
        if cut is not None:
            kept = self.trainer.episode
            self._last_ns = carry_over(self._recording, cut, kept, _RESULTS.name)
        self._events = EventLog(Path(f'{row.bag}.tensorboard'), self.trainer.episode)

    @property
    def saves_next(self) -> bool:
        """Whether the trainer is saved after the episode that is under way."""
        after = self.trainer.episode + 1
        return after % self.trainer.config.training.checkpoint_every == 0 or after >= self.episodes

    def episode_ended(self, summary: EpisodeSummary) -> None:
        """Record the episode, and take a checkpoint where one is due.

        Raises:
            BagError: the disk refuses.
        """
        # The start of an episode is a period after the end of the one before.
        self._last_ns += (summary.steps + 1) * CONTROL_PERIOD_NS
        data = serialise(self.row.run_id, summary, self._last_ns)
        self._recording.add_result(_RESULTS, data, summary.episode, summary.steps)
        self._events.add(summary)
        episode = self.trainer.episode
        if episode % self.trainer.config.training.checkpoint_every == 0:
            self._recording.secure()
            checkpoint.save(self._checkpoint, self.trainer, to_resume=True)
        self._on_episode(self.row, summary)

    def ended(self) -> None:
        """Save the agent, close the bag, and forget the checkpoint.

        Raises:
            BagError: the disk refuses.
        """
        agent = Path(f'{self.row.bag}.pt')
        checkpoint.save(agent, self.trainer, to_resume=False)
        self._recording.finish(self.episodes, {'checkpoint': agent.name})
        self._checkpoint.unlink(missing_ok=True)
        self._events.close()
        self._on_end(self.row, None)

    def failed(self, error: Exception) -> None:
        """Leave the bag readable, under its unfinished name."""
        self._recording.abandon()
        self._events.close()
        self._on_end(self.row, error)


def checkpoint_path(bag: Path) -> Path:
    """Return where the checkpoint of a run lies while its bag is unfinished."""
    return Path(f'{bag}.checkpoint.pt')


def _resumed(row: Row, config: AgentConfig) -> tuple[Trainer, Path | None]:
    """Return the trainer of a row and, where it goes on, the bag with the episodes it has had."""
    path = checkpoint_path(row.bag)
    if path.is_file():
        trainer = checkpoint.load(path, to_resume=True)
        if (trainer.spec.letters, trainer.seed) != (row.observations, row.seed):
            raise BagError(
                f'checkpoint {path}: observations {trainer.spec.letters!r}, seed {trainer.seed}; '
                f'expected {row.observations!r}, {row.seed} as the plan says'
            )
        if trainer.config != config:
            raise BagError(
                f'checkpoint {path}: begun with other hyper-parameters, expected the same; '
                'remove it to begin the row again'
            )
        cut = find_cut(row.bag, row.run_id, trainer.episode)
        if cut is not None:
            return trainer, cut
    return Trainer(ObservationSpec(row.observations), config, row.seed), None


def _metadata(row: Row, config: AgentConfig, episodes: int, device: str) -> dict[str, str]:
    """Return what the bag says of the run: as the graph's does, but that no topic was needed."""
    return {
        **row.metadata,
        'observations': row.observations,
        'seed': str(row.seed),
        'mode': 'train',
        'episodes': str(episodes),
        'window': str(config.training.window),
        'config': yaml.safe_dump(config.to_mapping(), sort_keys=False),
        'subscriptions': '',
        'device': device,
        **provenance(),
    }
