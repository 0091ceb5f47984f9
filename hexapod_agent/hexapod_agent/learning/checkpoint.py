# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Checkpoints: a run between two episodes as one file, an agent's with the run's state in it."""

from pathlib import Path

from hexapod_agent.deployment.agent_file import (
    CheckpointError,
    TrainedAgent,
    load_with_state,
    reason,
)
from hexapod_agent.learning.training import Trainer


def trained_agent(trainer: Trainer) -> TrainedAgent:
    """Return the agent of a run as it is now, and goes on to be as the run does."""
    return TrainedAgent(trainer.config, trainer.seed, trainer.episode, trainer.learner.policy())


def save_agent(path: str | Path, trainer: Trainer) -> None:
    """Write what acts, in less than a megabyte.

    Raises:
        CheckpointError: It cannot be written; the one before is still there.
    """
    trained_agent(trainer).save(path)


def save(path: str | Path, trainer: Trainer) -> None:
    """Write a run between two episodes, so that it can go on from there.

    Raises:
        CheckpointError: It cannot be written; the one before is still there.
    """
    trained_agent(trainer).save(path, trainer.state_dict())


def load(path: str | Path) -> Trainer:
    """Read a checkpoint into a trainer that goes on where the run was.

    Raises:
        CheckpointError: The file is missing, damaged, something else, of a specification that
            this version does not know, or an agent without its run.
    """
    agent, state = load_with_state(path)
    if state is None:
        raise CheckpointError(
            f'checkpoint {str(path)!r} holds an agent alone, expected a run that can be resumed'
        )
    try:
        trainer = Trainer(agent.config, agent.seed)
        trainer.load_state_dict(state)
    except Exception as error:  # whatever a file without a seal may hold
        raise CheckpointError(
            f'checkpoint {str(path)!r} cannot be used: {reason(error)}'
        ) from error
    return trainer
