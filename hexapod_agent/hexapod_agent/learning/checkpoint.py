# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Checkpoints: a run between two episodes as one file, written whole or not at all.

The file is a torch archive of tensors, numbers and text under a seal (`sealed_file`), and is read
without running code. What is not to the last bit what was written is refused. Files of before the
seal are held to the checksums of their archive, which do not cover all of it.
"""

import zipfile
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import torch

from hexapod_agent.deployment.sealed_file import Seal, read_seal, write_sealed
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec

FORMAT = 'hexapod-checkpoint-2'
UNSEALED_FORMAT = 'hexapod-checkpoint-1'


class CheckpointError(ValueError):
    """A file is no usable checkpoint, or cannot become one; the message names it and says why."""


def save(path: str | Path, trainer: Trainer, to_resume: bool) -> None:
    """Write a checkpoint; a crash leaves the old file or the new one, never a part.

    Args:
        path: The file.
        trainer: The run, between two episodes.
        to_resume: Whether the run can go on from it. Without, it holds the actor alone, which
            acts the same, in less than a megabyte.

    Raises:
        CheckpointError: It cannot be written; the one before is still there.
    """
    content = {
        'format': FORMAT,
        'seed': trainer.seed,
        'spec': trainer.config.to_mapping(),
        'state': trainer.state_dict(to_resume),
    }
    try:
        write_sealed(Path(path), partial(torch.save, content))
    except (OSError, RuntimeError) as error:  # torch has its own way to say that a disk is full
        raise CheckpointError(f'checkpoint {str(path)!r}: cannot be written: {error}') from error


def load(path: str | Path, to_resume: bool = False) -> Trainer:
    """Read a checkpoint into a trainer that acts as the saved one, or goes on where it was.

    Raises:
        CheckpointError: The file is missing, damaged, something else, of a configuration that
            this version does not know, or not `to_resume`.
    """
    content = _read(Path(path).expanduser())
    try:
        trainer = Trainer(_spec(content), content['seed'])
        trainer.load_state_dict(content['state'])
    except Exception as error:  # of another version, or whatever a file without a seal may hold
        raise CheckpointError(
            f'checkpoint {str(path)!r} cannot be used: {_reason(error)}'
        ) from error
    if to_resume and 'replay' not in content['state']:
        raise CheckpointError(
            f'checkpoint {str(path)!r} holds an agent alone, expected a run that can be resumed'
        )
    return trainer


def _spec(content: Mapping[str, Any]) -> RunSpec:
    """Return the run's specification; files of before there was one have it in two parts."""
    if 'spec' in content:
        return RunSpec.from_mapping(content['spec'], 'its specification')
    config = RunSpec.from_mapping(content['config'], 'its configuration')
    return config.observing(content['observations'])


def _read(path: Path) -> Mapping[str, Any]:
    """Unpack the archive and check that it is a whole one of ours."""
    if not path.is_file():
        raise CheckpointError(f'checkpoint {str(path)!r} not found, expected a file of `train`')
    try:
        seal = read_seal(path)
        if seal is Seal.ABSENT:
            _check_archive(path)
        content = torch.load(path, weights_only=True) if seal is not Seal.BROKEN else {}
    except Exception as error:  # torch raises whatever damaged bytes lead it to
        raise CheckpointError(
            f'checkpoint {str(path)!r} cannot be read, expected a whole file of `train`: '
            f'{_reason(error)}'
        ) from error
    found = content.get('format') if isinstance(content, dict) else None
    if seal is Seal.BROKEN or (seal is Seal.ABSENT and found == FORMAT):
        raise CheckpointError(
            f'checkpoint {str(path)!r} is damaged: it is not what was written, by its SHA-256; '
            'expected a whole file of `train`'
        )
    if found != (UNSEALED_FORMAT if seal is Seal.ABSENT else FORMAT):
        raise CheckpointError(f'checkpoint {str(path)!r}: expected format {FORMAT!r}')
    return content


def _check_archive(path: Path) -> None:
    """Hold a file without a seal to the checksums of its archive.

    Raises:
        zipfile.BadZipFile: One differs, or it is no archive.
    """
    with zipfile.ZipFile(path) as archive:
        damaged = archive.testzip()
    if damaged is not None:
        raise zipfile.BadZipFile(f'the checksum of {damaged} differs')


def _reason(error: Exception) -> str:
    """Return what an error says, in one line; torch fills pages."""
    return (str(error).strip() or type(error).__name__).splitlines()[0]
