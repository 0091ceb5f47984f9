# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The pattern generator: oscillators that keep their state, mapped to joint targets."""

import math

import numpy as np

from hexapod_cpg import oscillator
from hexapod_cpg.mapping import COMMAND_FIELDS, Command, joint_targets
from hexapod_cpg.oscillator import HopfConfig


class Cpg:
    """Central pattern generator of one robot, or of a batch of robots.

    Attributes:
        x: First state of the oscillators (*batch, 6).
        y: Second state (*batch, 6); y < 0 is swing.
    """

    x: np.ndarray
    y: np.ndarray

    def __init__(self, config: HopfConfig, batch: tuple[int, ...] = ()) -> None:
        self.config = config
        self.batch = batch
        self.reset()

    def reset(self) -> None:
        """Put the oscillators back to the gait's phases on the unit limit cycle."""
        self.x, self.y = oscillator.start_state(self.config, self.batch)

    def advance(self, command: Command) -> np.ndarray:
        """Advance one control period.

        Args:
            command: Arrays (*batch, 6).

        Returns:
            Joint targets (*batch, SUBSTEPS, 18) [rad]. Row i is the mapping of the oscillators
            at the end of sub-step i, so that the last row matches ``x`` and ``y`` afterwards.

        Raises:
            ValueError: A field of the command has another shape or is not finite.
        """
        _check_shapes(command, self.x.shape)
        xs, ys = oscillator.trajectory(self.x, self.y, command.mu, command.frequency, self.config)
        targets = joint_targets(_per_substep(command), xs, ys)
        # Every field reaches the targets, so one sum (cheaper than seven) tells if all are finite.
        if not math.isfinite(targets.sum()):
            raise ValueError(_describe_fault(command))
        self.x, self.y = xs[..., -1, :].copy(), ys[..., -1, :].copy()
        return targets


def _per_substep(command: Command) -> Command:
    """Return the command with an axis of one for the sub-steps: arrays (..., 1, 6)."""
    return Command(*(getattr(command, name)[..., None, :] for name in COMMAND_FIELDS))


def _check_shapes(command: Command, shape: tuple[int, ...]) -> None:
    """Raise ValueError unless every field has the given shape."""
    for name in COMMAND_FIELDS:
        if getattr(command, name).shape != shape:
            raise ValueError(
                f'command {name}: expected shape {shape}, got {getattr(command, name).shape}'
            )


def _describe_fault(command: Command) -> str:
    """Say which field made the targets infinite or NaN."""
    for name in COMMAND_FIELDS:
        if not np.isfinite(getattr(command, name)).all():
            return f'command {name}: expected finite values, got {getattr(command, name)}'
    return f'command: expected values that the integration can follow, got {command}'
