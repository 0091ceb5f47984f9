# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Films and strips: their form, what moves in them, and a name for what is missing."""

import importlib.util
import subprocess
import sys

import numpy as np
import pytest
from hexapod_sim.film import MOST_HEIGHT, MOST_WIDTH, Camera, FilmError, strip, write_film
from hexapod_sim.simulation import Simulation
from PIL import Image

from hexapod_sim import robot

SIZE = (64, 48)


def frames(count: int) -> list[np.ndarray]:
    """Return pictures with a square that moves."""
    made = np.full((count, 48, 64, 3), 200, np.uint8)
    for index, frame in enumerate(made):
        frame[10:20, 5 * index : 5 * index + 10] = (250, 120, 30)
    return list(made)


@pytest.fixture
def simulation() -> Simulation:
    return Simulation()


@pytest.fixture
def camera(simulation: Simulation):
    made = Camera(simulation, 'top', *SIZE)
    yield made
    made.close()


def test_picture_is_upright_and_of_its_size(simulation: Simulation, camera: Camera) -> None:
    # The top camera has +x above and +y on its left; 2 m below it 48 rows span 1.87 m.
    simulation.set_goal_line(0.5)
    frame = camera.shoot().astype(int)
    assert frame.shape == (48, 64, 3)
    greenness = (frame[:, :, 1] - frame[:, :, 0]).mean(axis=0)
    assert abs(greenness.argmax() - (31.5 - 0.5 * 48 / 1.87)) < 1.5
    # The body, dark and orange, is in the middle.
    assert frame[20:28, 28:36, 2].mean() < frame[:8, 40:, 2].mean() - 40


def test_pictures_follow_the_simulation(simulation: Simulation, camera: Camera) -> None:
    standing = camera.shoot()
    np.testing.assert_array_equal(camera.shoot(), standing)
    simulation.advance(np.tile(robot.NEUTRAL_POSE + 0.4, (robot.SUBSTEPS, 1)))
    assert (camera.shoot() != standing).any()


def test_drawing_leaves_the_physics_alone(simulation: Simulation, camera: Camera) -> None:
    alone = Simulation()
    targets = np.tile(robot.NEUTRAL_POSE + 0.1, (robot.SUBSTEPS, 1))
    for _ in range(5):
        camera.shoot()
        simulation.advance(targets)
        alone.advance(targets)
    np.testing.assert_array_equal(simulation.data.qpos, alone.data.qpos)
    np.testing.assert_array_equal(simulation.data.sensordata, alone.data.sensordata)


def test_gif_repeats_at_its_speed(tmp_path) -> None:
    write_film(frames(6), tmp_path / 'a.gif', 20)
    with Image.open(tmp_path / 'a.gif') as film:
        assert film.size == SIZE
        assert (film.n_frames, film.info['duration'], film.info['loop']) == (6, 50, 0)
        film.seek(5)
        last = np.asarray(film.convert('RGB')).astype(int)
    assert np.abs(last - frames(6)[5]).max() < 16


def test_strip_has_a_gap_between_frames() -> None:
    picture = strip(frames(3))
    assert picture.shape == (48, 3 * 64 + 2 * 6, 3)
    assert (picture[:, 64:70] == 255).all()
    np.testing.assert_array_equal(picture[:, 140:], frames(3)[2])


def test_unknown_kinds_and_a_missing_encoder_are_named(tmp_path, monkeypatch) -> None:
    with pytest.raises(FilmError, match=r'ends in \.gif or \.mp4'):
        write_film(frames(1), tmp_path / 'a.avi', 20)
    monkeypatch.setattr(importlib.util, 'find_spec', lambda name: None)
    with pytest.raises(FilmError, match='pip install imageio-ffmpeg'):
        write_film(frames(1), tmp_path / 'a.mp4', 20)


def test_missing_opengl_is_one_clear_error() -> None:
    code = (
        'import sys; sys.modules["mujoco.egl"] = None\n'
        'from hexapod_sim.film import Camera, FilmError\n'
        'from hexapod_sim.simulation import Simulation\n'
        'try: Camera(Simulation(), "top", 64, 48)\n'
        'except FilmError as error: print(error)\n'
    )
    ended = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, check=True
    )
    assert 'expected EGL: on Debian and Ubuntu `apt install libegl1' in ended.stdout


def test_the_largest_picture_is_the_one_of_the_model(simulation: Simulation) -> None:
    size = simulation.model.vis.global_
    assert (size.offwidth, size.offheight) == (MOST_WIDTH, MOST_HEIGHT)
