# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Pictures of robots from what was heard of them, drawn off-screen by MuJoCo in one thread."""

import io
import threading
from dataclasses import dataclass, replace

import mujoco
import numpy as np
from hexapod_sim.film import Camera, FilmError
from hexapod_sim.robot import FOOT_FRAMES
from hexapod_sim.simulation import Simulation
from hexapod_sim.world import World
from PIL import Image

from hexapod_bringup.watching.board import Board, Pose, Robot
from hexapod_bringup.watching.signals import LINE_OFFSET, ORIENTATION

WIDTH, HEIGHT = 480, 320
PICTURES_PER_SECOND = 5.0
_QUALITY = 80
_ZOOM = 1.6
_KEPT_STAGES = 3
_UPRIGHT = (0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Scene:
    """What a picture shows: taken from the board at one instant."""

    world: World
    joints: list[float]
    pose: Pose | None
    orientation: list[float] | None
    line_offset: float

    @classmethod
    def of(cls, robot: Robot) -> 'Scene | None':
        """Return the present scene of a robot; None until its joints are known."""
        if robot.joints is None:
            return None
        world = robot.world or World.of_article()
        if world.fault_period:
            is_sound = robot.outcome.get('step', 0) < world.fault_period
            at_once = replace(world.robot, fault_time=0.0)
            world = world.undamaged if is_sound else replace(world, robot=at_once)
        offset = robot.track(LINE_OFFSET).newest
        return cls(
            world,
            robot.joints,
            robot.pose,
            robot.track(ORIENTATION).newest,
            offset[0] if offset else 0.0,
        )


class Stage:
    """A model of one world, with the camera that looks at it."""

    def __init__(self, world: World) -> None:
        """Build the model.

        Raises:
            FilmError: there is no OpenGL to draw with.
        """
        self._simulation = Simulation(world)
        self._camera = Camera(self._simulation, 'track', WIDTH, HEIGHT, _ZOOM)

    def shoot(self, scene: Scene) -> bytes:
        """Return the picture as a JPEG."""
        simulation = self._simulation
        qpos = simulation.data.qpos
        qpos[7:25] = scene.joints
        if scene.pose is not None:
            qpos[:3] = scene.pose.position
            x, y, z, w = scene.pose.orientation
        else:  # no truth of a real robot: it stands on its lowest foot, upright without an IMU
            qpos[:3] = 0.0
            x, y, z, w = scene.orientation or _UPRIGHT
        qpos[3:7] = w, x, y, z
        mujoco.mj_forward(simulation.model, simulation.data)
        if scene.pose is None:
            qpos[2] = -min(simulation.data.site(foot).xpos[2] for foot in FOOT_FRAMES)
            mujoco.mj_forward(simulation.model, simulation.data)
        simulation.set_goal_line(float(qpos[1]) - scene.line_offset)
        picture = io.BytesIO()
        Image.fromarray(np.ascontiguousarray(self._camera.shoot())).save(
            picture, 'JPEG', quality=_QUALITY
        )
        return picture.getvalue()

    def close(self) -> None:
        """Free the camera."""
        self._camera.close()


class Studio:
    """Draws every robot that is looked at, a few times a second."""

    def __init__(self, board: Board) -> None:
        self._board = board
        self._stages: dict[World, Stage] = {}
        self._pictures: dict[str, bytes] = {}
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._work, name='studio', daemon=True)
        self.fault = ''
        """Why there are no pictures; empty while there is no reason."""

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def close(self) -> None:
        """End, and wait for it."""
        self._closing.set()
        self._thread.join()

    def picture(self, name: str) -> bytes | None:
        """Return the last picture of a robot, a JPEG."""
        return self._pictures.get(name)

    def _work(self) -> None:
        try:
            while not self._closing.wait(1.0 / PICTURES_PER_SECOND):
                self._draw_all()
        except (FilmError, ValueError, mujoco.FatalError) as error:
            self.fault = str(error)
        finally:
            for stage in self._stages.values():
                stage.close()

    def _draw_all(self) -> None:
        for name in self._board.watched():
            with self._board.lock:
                robot = self._board.robots.get(name)
                scene = Scene.of(robot) if robot else None
            if scene is not None and np.isfinite(scene.joints).all():
                self._pictures[name] = self._stage(scene.world).shoot(scene)

    def _stage(self, world: World) -> Stage:
        if world not in self._stages:
            while len(self._stages) >= _KEPT_STAGES:
                self._stages.pop(next(iter(self._stages))).close()
            self._stages[world] = Stage(world)
        return self._stages[world]
