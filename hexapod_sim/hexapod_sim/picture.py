# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What is to be seen of a simulation: pictures on demand, or a window that goes along."""

from typing import Any

import numpy as np

from hexapod_sim.film import MOST_HEIGHT, MOST_WIDTH, Camera, Frame
from hexapod_sim.simulation import Simulation
from hexapod_sim.viewer import Viewer

MODES = (None, 'rgb_array', 'human')
CAMERAS = ('track', 'top')


class Picture:
    """Draws a simulation in one of Gymnasium's render modes; nothing is opened before it is due.

    A copy has opened nothing.
    """

    def __init__(
        self, simulation: Simulation, mode: str | None, width: int, height: int, camera: str
    ) -> None:
        """Take note of what is wanted.

        Args:
            simulation: What is drawn.
            mode: None for nothing, `rgb_array` for pictures, `human` for a window.
            width: Of a picture, pixels.
            height: Of a picture, pixels.
            camera: `track` or `top`.

        Raises:
            ValueError: One of them is not what it can be.
        """
        if mode not in MODES:
            raise ValueError(f"render_mode {mode!r}: expected None, 'rgb_array' or 'human'")
        if camera not in CAMERAS:
            raise ValueError(f'camera {camera!r}: expected one of {", ".join(CAMERAS)}')
        if not (1 <= width <= MOST_WIDTH and 1 <= height <= MOST_HEIGHT):
            raise ValueError(
                f'picture of {width} x {height}: expected 1 x 1 to {MOST_WIDTH} x {MOST_HEIGHT} '
                'pixels'
            )
        self._simulation, self._mode = simulation, mode
        self._size, self._name = (width, height), camera
        self._camera: Camera | None = None
        self._viewer: Viewer | None = None

    def __getstate__(self) -> dict[str, Any]:
        return vars(self) | {'_camera': None, '_viewer': None}

    def advance(self) -> None:
        """Show in the window, if there is to be one, what has just been simulated."""
        if self._mode != 'human':
            return
        if self._viewer is None:
            self._viewer = Viewer(self._simulation)
        self._viewer.show()

    def draw(self) -> Frame | None:
        """Return the picture of now (height, width, 3), RGB, if pictures are wanted.

        Raises:
            hexapod_sim.film.FilmError: There is nothing to draw with.
        """
        if self._mode != 'rgb_array':
            return None
        if self._camera is None:
            self._camera = Camera(self._simulation, self._name, *self._size)
        return np.ascontiguousarray(self._camera.shoot())

    def close(self) -> None:
        """Close what was opened."""
        for opened in (self._camera, self._viewer):
            if opened is not None:
                opened.close()
        self._camera = self._viewer = None
