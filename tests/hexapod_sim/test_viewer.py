# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The live viewer: one clear error without a display, real time with one."""

import time
from types import SimpleNamespace

import mujoco.viewer
import pytest
from hexapod_sim.simulation import Simulation
from hexapod_sim.viewer import Viewer, ViewerError


class Window:
    """Stands in for the handle of MuJoCo's viewer, which needs a display."""

    def __init__(self) -> None:
        self.cam = SimpleNamespace()
        self.open = True
        self.syncs = 0

    def is_running(self) -> bool:
        return self.open

    def sync(self) -> None:
        self.syncs += 1

    def close(self) -> None:
        self.open = False


@pytest.fixture
def window(monkeypatch) -> Window:
    made = Window()
    monkeypatch.setenv('DISPLAY', ':0')
    monkeypatch.setattr(mujoco.viewer, 'launch_passive', lambda *_, **__: made)
    return made


def test_without_a_display_there_is_one_clear_error(monkeypatch) -> None:
    for name in ('DISPLAY', 'WAYLAND_DISPLAY'):
        monkeypatch.delenv(name, raising=False)
    with pytest.raises(ViewerError, match='viewer: no display'):
        Viewer(Simulation())


def test_the_window_is_shown_in_real_time(window: Window) -> None:
    simulation = Simulation()
    begin = time.monotonic()
    viewer = Viewer(simulation)
    for _ in range(8):
        viewer.show()
    assert time.monotonic() - begin >= 8 * 0.025 - 1e-3
    assert window.syncs == 8
    viewer.close()
    assert not window.open


def test_a_closed_window_does_not_hold_the_robot_up(window: Window) -> None:
    viewer = Viewer(Simulation())
    window.open = False
    begin = time.monotonic()
    for _ in range(100):
        viewer.show()
    assert time.monotonic() - begin < 1.0
    assert window.syncs == 0
