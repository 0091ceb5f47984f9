# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The checkpoint beside the bag of a run, from which the run goes on after it was cut."""

from __future__ import annotations

from pathlib import Path

from hexapod_agent import checkpoint
from hexapod_agent.checkpoint import CheckpointError
from hexapod_agent.config import AgentConfig
from hexapod_agent.observation import ObservationSpec
from hexapod_agent.training import Trainer


def checkpoint_path(bag: str | Path) -> Path:
    """Return where the checkpoint of a bag's run is."""
    return Path(f'{bag}.checkpoint.pt')


def keep(bag: str | Path, trainer: Trainer) -> None:
    """Take the checkpoint of a run between two episodes.

    Raises:
        CheckpointError: it cannot be written; the one before is still there.
    """
    checkpoint.save(checkpoint_path(bag), trainer, to_resume=True)


def resumed(
    bag: str | Path, spec: ObservationSpec, config: AgentConfig, seed: int, episodes: int
) -> Trainer | None:
    """Return a trainer that goes on where the run was at its checkpoint; None without one.

    Raises:
        CheckpointError: the checkpoint is damaged, or of another run than this.
    """
    path = checkpoint_path(bag)
    if not path.exists():
        return None
    trainer = checkpoint.load(path, to_resume=True)
    found = (trainer.spec.letters, trainer.seed, trainer.config)
    if found != (spec.letters, seed, config) or trainer.episode >= episodes:
        raise CheckpointError(
            f'checkpoint {str(path)!r}: of another run (sensors {trainer.spec.letters or "none"}, '
            f'seed {trainer.seed}, {trainer.episode} episodes), expected sensors '
            f'{spec.letters or "none"}, seed {seed}, less than {episodes} episodes, and the same '
            'configuration'
        )
    return trainer


def forget(bag: str | Path) -> None:
    """Remove the checkpoint of a run that is complete."""
    checkpoint_path(bag).unlink(missing_ok=True)
