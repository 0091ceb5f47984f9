# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Pictures of a simulation, drawn off-screen, and the files that they make: films and strips."""

import importlib.util
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from hexapod_sim.simulation import Simulation

Frame = NDArray[np.uint8]

FILMS = ('.gif', '.mp4')
"""How the name of a film may end."""
PICTURES = ('.png', '.jpg', '.jpeg', '.webp')
"""How the name of a picture may end."""
MOST_WIDTH, MOST_HEIGHT = 1280, 720  # pixels: offwidth and offheight of hexapod.xml

_COLOURS = 96  # of a GIF's palette: more make it larger and the robot no prettier
_DECOR = 1000  # sites, lights and the like that are drawn beside a model's geoms
_GAP = 6  # white pixels between the frames of a strip


class FilmError(RuntimeError):
    """Nothing can be drawn or written here; the text says what is missing."""


class Camera:
    """Draws a simulation as one of its model's cameras sees it, without a display.

    The robot stays in the middle of the picture.
    """

    def __init__(
        self, simulation: Simulation, name: str, width: int, height: int, zoom: float = 1.0
    ) -> None:
        """Open a drawing surface.

        Args:
            simulation: What is drawn.
            name: A camera of hexapod.xml: `track` or `top`.
            width: Of the picture, pixels; at most the model's `offwidth`.
            height: Of the picture, pixels; at most `offheight`.
            zoom: How much larger things are than through the model's own lens.

        Raises:
            FilmError: there is no OpenGL to draw with.
        """
        self._simulation = simulation
        self._zoom = zoom
        self._rectangle = mujoco.MjrRect(0, 0, width, height)
        self._camera = mujoco.MjvCamera()
        self._camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
        self._camera.fixedcamid = simulation.model.camera(name).id
        self._options = mujoco.MjvOption()
        self._scene = mujoco.MjvScene(simulation.model, simulation.model.ngeom + _DECOR)
        self._surface = _surface(width, height)
        self._surface.make_current()
        self._context = mujoco.MjrContext(
            simulation.model, mujoco.mjtFontScale.mjFONTSCALE_100.value
        )
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)

    def shoot(self) -> Frame:
        """Return the picture of now (height, width, 3), RGB."""
        self._surface.make_current()
        mujoco.mjv_updateScene(
            self._simulation.model,
            self._simulation.data,
            self._options,
            None,
            self._camera,
            mujoco.mjtCatBit.mjCAT_ALL.value,
            self._scene,
        )
        for eye in self._scene.camera:
            eye.frustum_bottom /= self._zoom
            eye.frustum_top /= self._zoom
        mujoco.mjr_render(self._rectangle, self._scene, self._context)
        frame = np.empty((self._rectangle.height, self._rectangle.width, 3), np.uint8)
        mujoco.mjr_readPixels(frame, None, self._rectangle, self._context)
        return np.flipud(frame)  # OpenGL's rows begin at the bottom

    def close(self) -> None:
        """Free the surface."""
        self._context.free()
        self._surface.free()


def _surface(width: int, height: int) -> Any:
    """Open an OpenGL context: MuJoCo's choice where MUJOCO_GL makes one, else EGL on Linux."""
    try:
        if 'MUJOCO_GL' not in os.environ and sys.platform == 'linux':
            from mujoco.egl import GLContext
        else:
            from mujoco.gl_context import GLContext
        return GLContext(width, height)
    except Exception as error:  # whatever loader, driver or wrapper lacks: each has its own type
        raise FilmError(
            f'no OpenGL to draw with off-screen ({error}), expected EGL: on Debian and Ubuntu '
            f'`apt install libegl1 libgl1`'
        ) from error


def write_film(frames: Sequence[Frame], path: Path, frames_per_second: int) -> None:
    """Write frames as a GIF that repeats, or as an MP4.

    Raises:
        FilmError: the file's name ends otherwise, or MP4 has no encoder.
    """
    if path.suffix == '.gif':
        _write_gif(frames, path, frames_per_second)
    elif path.suffix == '.mp4':
        _write_mp4(frames, path, frames_per_second)
    else:
        raise FilmError(f"film '{path}': expected a name that ends in .gif or .mp4")


def _write_gif(frames: Sequence[Frame], path: Path, frames_per_second: int) -> None:
    # One palette for all frames, or colours flicker; without dithering, or nothing compresses.
    palette = Image.fromarray(frames[0]).quantize(_COLOURS)
    images = [
        Image.fromarray(frame).quantize(palette=palette, dither=Image.Dither.NONE)
        for frame in frames
    ]
    images[0].save(
        path,
        save_all=True,
        append_images=images[1:],
        duration=round(1000 / frames_per_second),
        loop=0,
        optimize=True,
    )


def _write_mp4(frames: Sequence[Frame], path: Path, frames_per_second: int) -> None:
    if importlib.util.find_spec('imageio_ffmpeg') is None:
        raise FilmError(
            f"film '{path}': MP4 needs an encoder, expected `pip install imageio-ffmpeg`, or a "
            'name that ends in .gif'
        )
    from imageio_ffmpeg import write_frames

    height, width, _ = frames[0].shape
    writer = write_frames(str(path), (width, height), fps=frames_per_second)
    writer.send(None)
    for frame in frames:
        writer.send(np.ascontiguousarray(frame))
    writer.close()


def strip(frames: Sequence[Frame]) -> Frame:
    """Return the frames side by side, with a white gap between them."""
    gap = np.full((frames[0].shape[0], _GAP, 3), 255, np.uint8)
    parts = [frames[0], *(part for frame in frames[1:] for part in (gap, frame))]
    return np.concatenate(parts, axis=1)


def write_picture(frame: Frame, path: Path) -> None:
    """Write one picture, as the name of the file says."""
    Image.fromarray(frame).save(path, optimize=True)
