# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The robot on its ground: MuJoCo physics advanced one control period at a time, with queries."""

import copy
import math
from itertools import pairwise
from typing import Any

import mujoco
import numpy as np

from hexapod_sim import robot
from hexapod_sim.sensor_table import MEASURED
from hexapod_sim.variations.fault import Fault
from hexapod_sim.world import World

_KEYFRAME = 'standing'
# The servos give under the weight and the feet creep outwards: after this many control periods
# (10 s, 30 ms of computing) nothing moves faster than 1e-5 m/s or rad/s.
_SETTLE_PERIODS = 400
# Sum of squared generalised velocities [(m/s)^2 and (rad/s)^2] that no working servo reaches
# (all 18 at ten times their no-load speed); beyond it, or at NaN, the state is lost.
_SQUARED_SPEED_LIMIT = len(robot.JOINTS) * (10 * robot.NO_LOAD_SPEED) ** 2
_NO_SENSORS = int(mujoco.mjtDisableBit.mjDSBL_SENSOR)


class SimulationDivergedError(RuntimeError):
    """The physics left the range of meaningful states; reset the simulation to go on."""


class Simulation:
    """Physics of one hexapod; a copy, by `copy.deepcopy` or pickle, goes on to the last bit.

    Attributes:
        world: What it is built of.
        model: The compiled hexapod.xml on the ground of its scene; a fault changes it in place.
        data: State of the model; sensor readings are those at the end of the last period.
        sensordata: The data's sensor readings, all in a row.
        sensor_blocks: Where the sensors of each reading lie in ``sensordata``.
    """

    def __init__(self, world: World | None = None) -> None:
        """Build the model, and let the robot stand.

        Args:
            world: What it is built of; article.yaml's by default.
        """
        self.world = world or World.of_article()
        model, self._scene, self._fault = self.world.build()
        self._period = 0
        self.sensor_blocks = _locate_blocks(model)
        self._flags_with_sensors = model.opt.disableflags
        self._steps_per_target = whole_ratio(robot.TARGET_PERIOD_NS, robot.PHYSICS_STEP_NS)
        self._bind(model, mujoco.MjData(model))
        self._standing_qpos, self._tilt = self._settle()
        self.reset(0.0)

    def _bind(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Take over a model with its data."""
        self.model, self.data = model, data
        # Views into MuJoCo's structures, fetched once: attribute access costs more than the copy.
        self._options = model.opt
        self._ctrl = data.ctrl
        self._qpos = data.qpos
        self._qvel = data.qvel
        self.sensordata = data.sensordata

    def __getstate__(self) -> dict[str, Any]:
        state = vars(self).copy()
        for name in ('model', '_options', '_ctrl', '_qpos', '_qvel', 'sensordata'):
            del state[name]
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        source = state.pop('data')
        vars(self).update(state)
        # A model of its own, as each simulation has: `advance` switches the model's sensors.
        model = copy.deepcopy(source.model)
        data = mujoco.MjData(model)
        mujoco.mj_copyData(data, model, source)
        self._bind(model, data)

    def reset(self, y: float, yaw: float = 0.0) -> None:
        """Stand the robot still on the flat run-up at (0, y) of odom, heading ``yaw``.

        Everything that MuJoCo carries from step to step is cleared first, so that what follows
        equals, to the last bit, what follows in a new simulation.

        Args:
            y: Lateral position of base_link in odom [m].
            yaw: Heading [rad], counter-clockwise from odom's x axis.
        """
        self._period = 0
        if self._fault is not None:
            self._fault.write(self.model, is_there=False)
        mujoco.mj_resetData(self.model, self.data)
        self._qpos[:] = self._standing_qpos
        self._qpos[1] = y
        self._qpos[3:7] = math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)
        if self._tilt is not None:
            mujoco.mju_mulQuat(self._qpos[3:7], self._qpos[3:7].copy(), self._tilt)
        self._ctrl[:] = robot.NEUTRAL_POSE
        mujoco.mj_forward(self.model, self.data)

    def advance(self, targets: np.ndarray) -> None:
        """Advance one control period, giving each joint target to the servos in turn.

        Args:
            targets: Joint angles (SUBSTEPS, 18) [rad]; row i holds from i to i + 1 times the
                target period.

        Raises:
            ValueError: The targets have another shape or are not finite.
            SimulationDivergedError: The state left the meaningful range.
        """
        targets = np.asarray(targets, dtype=np.float64)
        _check_targets(targets)
        if self._fault is not None:
            self._meet(self._fault)
        # Position and velocity stages of the first step were computed by the last mj_forward.
        # Sensors are read once per period, so only the closing mj_forward evaluates them.
        model, data, ctrl = self.model, self.data, self._ctrl
        self._options.disableflags = self._flags_with_sensors | _NO_SENSORS
        ctrl[:] = targets[0]
        mujoco.mj_step2(model, data)
        if self._steps_per_target > 1:
            mujoco.mj_step(model, data, self._steps_per_target - 1)
        for target in targets[1:]:
            ctrl[:] = target
            mujoco.mj_step(model, data, self._steps_per_target)
        self._options.disableflags = self._flags_with_sensors
        mujoco.mj_forward(model, data)
        self._check_state()

    def _meet(self, fault: Fault) -> None:
        """Count a control period, and let the fault come before its own."""
        if self._period == fault.period:
            fault.write(self.model, is_there=True)
            self.data.eq_active[:] = self.model.eq_active0
            mujoco.mj_forward(self.model, self.data)
        self._period += 1

    def set_goal_line(self, y: float) -> None:
        """Move the visible goal line to y [m] of odom; it touches nothing."""
        self.data.mocap_pos[0, 1] = y
        # What is drawn is the site, which would follow with the next control period only.
        self.data.site('goal_line').xpos[1] = y

    def ground(self, x: float, y: float) -> float:
        """Return the height of the ground at a place of odom [m]."""
        return float(self._scene.height(x, y))

    @property
    def position(self) -> np.ndarray:
        """Position of base_link in odom (3,) [m]."""
        return self._qpos[:3].copy()

    @property
    def orientation(self) -> np.ndarray:
        """Orientation of base_link in odom, quaternion x y z w (4,)."""
        return self._qpos[[4, 5, 6, 3]]

    def pose(self) -> tuple[float, float, float, float, float, float]:
        """Return x, y, z [m] and roll, pitch, yaw [rad] of base_link in odom.

        Angles are those of `roll_pitch_yaw`.
        """
        x, y, z, qw, qx, qy, qz = self._qpos[:7].tolist()
        return x, y, z, *roll_pitch_yaw(qx, qy, qz, qw)

    def _settle(self) -> tuple[np.ndarray, np.ndarray | None]:
        """Let the keyframe's pose sink onto the floor.

        Returns:
            Its configuration at rest, and how it is tilted: a quaternion w x y z, None for a sound
            robot, which is level.
        """
        key = self.model.key(_KEYFRAME).id
        mujoco.mj_resetDataKeyframe(self.model, self.data, key)
        mujoco.mj_step(self.model, self.data, _SETTLE_PERIODS * robot.SUBSTEPS)
        rest = self._qpos.copy()
        rest[:2] = 0.0
        if self._fault is not None or not self.world.robot.variations:
            return rest, None
        return rest, _without_yaw(rest[3:7])

    def _check_state(self) -> None:
        """Raise if the state diverged; the comparison is false for NaN."""
        if not self._qvel @ self._qvel < _SQUARED_SPEED_LIMIT:
            raise SimulationDivergedError(
                f'simulation: state diverged before t = {self.data.time:.3f} s, expected '
                f'squared speed below {_SQUARED_SPEED_LIMIT:.0f}, got {self._qvel @ self._qvel}'
            )


def roll_pitch_yaw(qx: float, qy: float, qz: float, qw: float) -> tuple[float, float, float]:
    """Return the fixed-axis roll, pitch, yaw of REP-103 [rad] of a unit quaternion x y z w."""
    roll = math.atan2(2 * (qw * qx + qy * qz), 1 - 2 * (qx * qx + qy * qy))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (qw * qy - qz * qx))))
    yaw = math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
    return roll, pitch, yaw


def _without_yaw(wxyz: np.ndarray) -> np.ndarray:
    """Return an orientation, as a quaternion w x y z, turned back to the heading of odom's x."""
    w, x, y, z = wxyz.tolist()
    _, _, yaw = roll_pitch_yaw(x, y, z, w)
    tilt = np.empty(4)
    mujoco.mju_mulQuat(tilt, np.array([math.cos(yaw / 2), 0.0, 0.0, -math.sin(yaw / 2)]), wxyz)
    return tilt


def _locate_blocks(model: mujoco.MjModel) -> dict[str, slice]:
    """Return where the model's sensors of each reading lie in ``sensordata``.

    Raises:
        ValueError: The model does not list the sensors of a reading in a row.
    """
    blocks = {}
    for reading, field in MEASURED.items():
        found = map(model.sensor, field.sources)
        spans = [(int(s.adr[0]), int(s.adr[0] + s.dim[0])) for s in found]
        if any(left[1] != right[0] for left, right in pairwise(spans)):
            raise ValueError(f'sensors of {reading!r}: expected them in a row in the model')
        blocks[reading] = slice(spans[0][0], spans[-1][1])
    return blocks


def whole_ratio(period_ns: int, step_ns: int) -> int:
    """Return how many steps make a period.

    Raises:
        ValueError: The period is not a whole number of steps.
    """
    count, rest = divmod(period_ns, step_ns)
    if rest or count < 1:
        raise ValueError(
            f'physics step {step_ns} ns: expected a whole fraction of the period {period_ns} ns'
        )
    return count


def _check_targets(targets: np.ndarray) -> None:
    """Raise ValueError unless the targets are finite joint angles of one control period."""
    expected = (robot.SUBSTEPS, len(robot.JOINTS))
    if targets.shape != expected:
        raise ValueError(f'joint targets: expected shape {expected}, got {targets.shape}')
    # One reduction is cheaper than isfinite().all(); NaN and infinity both survive a sum.
    if not math.isfinite(targets.sum()):
        raise ValueError('joint targets: expected finite angles, got NaN or infinity')
