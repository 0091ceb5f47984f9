# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The checkpoint beside the bag of a run, from which the run goes on after it was cut."""

from pathlib import Path

from hexapod_agent.deployment.agent_file import CheckpointError
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec

_SHOWN = 3  # differences that a message names


def checkpoint_path(bag: str | Path) -> Path:
    """Return where the checkpoint of a bag's run is."""
    return Path(f'{bag}.checkpoint.pt')


def keep(bag: str | Path, trainer: Trainer) -> None:
    """Take the checkpoint of a run between two episodes.

    Raises:
        CheckpointError: it cannot be written; the one before is still there.
    """
    checkpoint.save(checkpoint_path(bag), trainer)


def resumed(bag: str | Path, config: RunSpec, seed: int) -> Trainer | None:
    """Return a trainer that goes on where the run was at its checkpoint; None without one.

    Raises:
        CheckpointError: the checkpoint is damaged, or of another run than this.
    """
    path = checkpoint_path(bag)
    if not path.exists():
        return None
    trainer = checkpoint.load(path)
    episodes = config.training.episodes
    if config.training.final_rate == 1.0:  # its length changes nothing of what it has learned
        trainer.config = trainer.config.with_value('training.episodes', episodes, str(path))
    differences = different(trainer, config, seed)
    if trainer.episode >= episodes:
        differences.append(f'{trainer.episode} episodes have been, less than {episodes} expected')
    if differences:
        raise CheckpointError(
            f'checkpoint {str(path)!r}: of another run: {listed(differences)}; expected the same '
            'specification and seed, and less episodes'
        )
    return trainer


def different(
    trainer: Trainer, config: RunSpec | None = None, seed: int | None = None
) -> list[str]:
    """Return in what a run is another than the one that is asked for; None asks for nothing."""
    values: dict[str, tuple[object, object]] = {}
    if seed is not None and seed != trainer.seed:
        values['seed'] = (seed, trainer.seed)
    if config is not None:
        values |= config.differences(trainer.config)
        if config.letters != trainer.config.letters:
            sets = {'observations': (config.letters, trainer.config.letters)}
            others = {k: v for k, v in values.items() if not k.startswith('observations.')}
            values = sets | others  # a message names the first ones
    return [f'{key} is {asked!r} here, {found!r} there' for key, (asked, found) in values.items()]


def listed(differences: list[str]) -> str:
    """Return differences as a part of a message, the first of them if there are many."""
    more = len(differences) - _SHOWN
    return '; '.join([*differences[:_SHOWN], *([f'and {more} more'] if more > 0 else [])])


def forget(bag: str | Path) -> None:
    """Remove the checkpoint of a run that is complete."""
    checkpoint_path(bag).unlink(missing_ok=True)
