# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A window that shows a simulation while it runs, in real time."""

import os
import sys
import time

import mujoco

from hexapod_sim.robot import CONTROL_PERIOD_NS
from hexapod_sim.simulation import Simulation

_PERIOD_S = CONTROL_PERIOD_NS * 1e-9


class ViewerError(ValueError):
    """There is nowhere to open a window."""


def has_display() -> bool:
    """Return whether there is somewhere to open a window."""
    return sys.platform != 'linux' or bool({'DISPLAY', 'WAYLAND_DISPLAY'} & os.environ.keys())


class Viewer:
    """MuJoCo's passive viewer, its camera on the robot; closing the window ends the pacing.

    Attributes:
        paced: Whether `show` waits until a control period is over.
    """

    def __init__(self, simulation: Simulation, paced: bool = True) -> None:
        """Open the window.

        Args:
            simulation: What to show.
            paced: Whether `show` waits until a control period is over.

        Raises:
            ViewerError: there is no display.
        """
        if not has_display():
            raise ViewerError(
                'viewer: no display (DISPLAY is not set), expected a desktop; without one, '
                '`ros2 run hexapod_agent film` draws off-screen'
            )
        from mujoco import viewer  # here: it loads the window system's libraries

        self._handle = viewer.launch_passive(
            simulation.model, simulation.data, show_left_ui=False, show_right_ui=False
        )
        self._handle.cam.type = mujoco.mjtCamera.mjCAMERA_TRACKING
        self._handle.cam.trackbodyid = simulation.model.body('base_link').id
        self.paced = paced
        self._due = time.monotonic()

    def show(self) -> None:
        """Show the simulation as it is; if paced, not before a period after the last time."""
        if not self._handle.is_running():
            return
        if not self.paced:
            self._handle.sync()
            return
        now = time.monotonic()
        self._due = max(self._due + _PERIOD_S, now)  # late once is not to be made up for
        time.sleep(self._due - now)
        self._handle.sync()

    def close(self) -> None:
        """Close the window."""
        self._handle.close()
