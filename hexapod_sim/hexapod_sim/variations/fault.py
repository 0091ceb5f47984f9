# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The moment at which a sound robot becomes another one."""

import mujoco
import numpy as np


class Fault:
    """Turns one model, in place, into another of the same structure, and back.

    In place, so that who holds the model, such as a window, sees it; numbers alone, so that the
    state of the physics goes on.

    Attributes:
        period: Control periods of an episode before it.
    """

    def __init__(self, sound: mujoco.MjModel, varied: mujoco.MjModel, period: int) -> None:
        """Find out in what two models differ.

        Args:
            sound: The model before the fault.
            varied: After it.
            period: Control periods before it.

        Raises:
            ValueError: Their structures differ.
        """
        self.period = period
        self._numbers: dict[str, tuple[np.ndarray, np.ndarray]] = {}
        for name in dir(sound):
            before, after = getattr(sound, name), getattr(varied, name)
            if not isinstance(before, np.ndarray) or np.array_equal(before, after):
                continue
            if before.shape != after.shape:
                raise ValueError(
                    f'fault: {name} has {before.shape} before and {after.shape} after'
                )
            self._numbers[name] = before.copy(), after.copy()
        self._inertia = sound.stat.meaninertia, varied.stat.meaninertia

    def write(self, model: mujoco.MjModel, is_there: bool) -> None:
        """Make a model the one before the fault or the one after it."""
        for name, numbers in self._numbers.items():
            getattr(model, name)[:] = numbers[is_there]
        model.stat.meaninertia = self._inertia[is_there]
