# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The sim in real time: one control period per tick of the clock, with the newest trajectory."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_node.newest import Input, NewestSamples
from hexapod_node.ticker import Tick, Ticker
from trajectory_msgs.msg import JointTrajectory

from hexapod_sim.nodes.messages import targets_from_message
from hexapod_sim.plant import Plant
from hexapod_sim.robot import CONTROL_PERIOD_NS
from hexapod_sim.task import LineTask, Outcome
from hexapod_sim.task_config import TaskConfig

if TYPE_CHECKING:
    from hexapod_node.diagnostics import Health
    from rclpy.node import Node

_TOPIC = 'joint_trajectory'
# A longer pause is not made up for: the world stood still meanwhile.
_CATCH_UP_PERIODS = 40
_THROTTLE_S = 1.0


class RealTime:
    """Ticks the plant and says when it cannot keep up."""

    def __init__(
        self,
        node: Node,
        task: LineTask,
        config: TaskConfig,
        publish: Callable[[Outcome, int], None],
    ) -> None:
        """Begin to tick.

        Args:
            node: with the parameters of the sim.
            task: robot and line.
            config: of the task.
            publish: takes the outcome of a control period and the stamp of its end.

        Raises:
            ValueError: the node would follow the time that it makes.
        """
        if node.get_parameter('use_sim_time').value:
            raise ValueError('use_sim_time: the sim makes the time, expected false')
        self._node = node
        self._publish = publish
        self._factor = float(node.get_parameter('real_time_factor').value)
        self._plant = Plant(task)
        self._plant.reset(node.get_parameter('seed').value, config)
        self._now_ns = node.get_clock().now().nanoseconds if self._factor == 1.0 else 0
        self._caught_up = self._skipped = 0
        max_age_ns = round(node.get_parameter('max_age').value * 1e9)
        wanted = Input(JointTrajectory, max_age_ns, targets_from_message)
        clock = None if self._factor == 1.0 else lambda: self._now_ns
        self._samples = NewestSamples(node, {_TOPIC: wanted}, clock)
        phase_ns = round(node.get_parameter('phase').value * 1e9)
        period_ns = round(CONTROL_PERIOD_NS / self._factor)
        self._ticker = Ticker(node, period_ns, self._on_tick, phase_ns)
        self._reported = (time.monotonic_ns(), self._now_ns)

    def reset(self, seed: int, config: TaskConfig) -> int:
        """Put the robot at the seeded start and measure afresh; return the next sample's stamp."""
        self._plant.reset(seed, config)
        self._ticker.meter.restart()
        self._caught_up = self._skipped = 0
        return self._now_ns + CONTROL_PERIOD_NS

    def health(self) -> Health:
        """Return what the diagnostics show."""
        now = (time.monotonic_ns(), self._now_ns)
        wall_ns, simulated_ns = (a - b for a, b in zip(now, self._reported, strict=True))
        self._reported = now
        values = {
            'real_time_factor': f'{simulated_ns / max(wall_ns, 1):.3f}',
            'caught_up_periods': self._caught_up,
            'skipped_periods': self._skipped,
            **self._ticker.meter.values(),
            **self._samples.values(),
        }
        warning = self._samples.contest()
        if self._skipped:
            warning = f'{self._skipped} periods skipped: the sim does not keep up'
        if warning:
            return DiagnosticStatus.WARN, warning, values
        return DiagnosticStatus.OK, self._samples.fault() or 'in real time', values

    def _on_tick(self, tick: Tick) -> None:
        """Simulate the period that is due, and those that were missed."""
        newest = self._samples.take()
        if newest is not None:
            self._plant.play(newest[_TOPIC])
        periods = 1 + tick.missed
        if tick.missed:
            self._warn(tick)
        self._skipped += max(periods - _CATCH_UP_PERIODS, 0)
        for index in range(max(periods - _CATCH_UP_PERIODS, 0), periods):
            outcome = self._plant.advance()
            if self._factor == 1.0:
                due_ns = tick.stamp_ns - (tick.missed - index) * CONTROL_PERIOD_NS
                self._now_ns = max(self._now_ns + 1, due_ns)
            else:
                self._now_ns += CONTROL_PERIOD_NS
            self._publish(outcome, self._now_ns)

    def _warn(self, tick: Tick) -> None:
        self._caught_up += min(tick.missed, _CATCH_UP_PERIODS - 1)
        self._node.get_logger().warning(
            f'behind real time by {tick.late_ns * 1e-6:.0f} ms: {tick.missed} periods to catch up '
            f'with, {_CATCH_UP_PERIODS - 1} at most',
            throttle_duration_sec=_THROTTLE_S,
        )
