# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Checkpoints: a run between two episodes as one file, written whole or not at all.

The file is a torch archive of tensors, numbers and text, and is read without running code.
"""

import os
import pickle
from pathlib import Path
from typing import Any

import torch

from hexapod_agent.config import AgentConfig
from hexapod_agent.observation import ObservationSpec
from hexapod_agent.training import Trainer

FORMAT = 'hexapod-checkpoint-1'


class CheckpointError(ValueError):
    """A file is no usable checkpoint; the message names it and what was expected."""


def save(path: str | Path, trainer: Trainer, to_resume: bool) -> None:
    """Write a checkpoint; a crash leaves the old file or the new one, never a part.

    Args:
        path: The file.
        trainer: The run, between two episodes.
        to_resume: Whether the run can go on from it. Without, it holds the actor alone, which
            acts the same, in less than a megabyte.
    """
    path = Path(path)
    content = {
        'format': FORMAT,
        'observations': trainer.spec.letters,
        'seed': trainer.seed,
        'config': trainer.config.to_mapping(),
        'state': trainer.state_dict(to_resume),
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f'{path.name}.partial')
    with partial.open('wb') as file:
        torch.save(content, file)
        file.flush()
        os.fsync(file.fileno())
    partial.replace(path)
    _sync_directory(path.parent)


def load(path: str | Path, to_resume: bool = False) -> Trainer:
    """Read a checkpoint into a trainer that acts as the saved one, or goes on where it was.

    Raises:
        CheckpointError: The file is missing, cut short, something else, or not `to_resume`.
    """
    content = _read(Path(path))
    if to_resume and 'replay' not in content['state']:
        raise CheckpointError(
            f'checkpoint {str(path)!r} holds an agent alone, expected a run that can be resumed'
        )
    config = AgentConfig.from_mapping(content['config'], str(path))
    trainer = Trainer(ObservationSpec(content['observations']), config, content['seed'])
    trainer.load_state_dict(content['state'])
    return trainer


def _read(path: Path) -> dict[str, Any]:
    """Unpack the archive and check that it is one of ours."""
    if not path.is_file():
        raise CheckpointError(f'checkpoint {str(path)!r} not found, expected a file of `train`')
    try:
        content = torch.load(path, weights_only=True)
    except (OSError, RuntimeError, EOFError, pickle.UnpicklingError) as error:
        raise CheckpointError(
            f'checkpoint {str(path)!r} cannot be read, expected a whole file of `train`: {error}'
        ) from error
    if not isinstance(content, dict) or content.get('format') != FORMAT:
        raise CheckpointError(f'checkpoint {str(path)!r}: expected format {FORMAT!r}')
    return content


def _sync_directory(directory: Path) -> None:
    """Make the renaming itself durable."""
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
