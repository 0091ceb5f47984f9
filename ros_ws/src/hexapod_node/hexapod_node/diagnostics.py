# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A node's health on /diagnostics, once a second."""

from collections.abc import Callable, Mapping

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from hexapod_node.handlers import failures
from hexapod_node.timers import call_every

_PERIOD_S = 1.0

Health = tuple[bytes, str, Mapping[str, object]]
"""Level (OK, WARN, ERROR of DiagnosticStatus), one line of text, and named values."""


class Diagnostics:
    """Publishes what the node says of itself, on wall time: a stalled sim still reports."""

    def __init__(self, node: Node, health: Callable[[], Health], hardware: str = 'none') -> None:
        self._node = node
        self._health = health
        self._hardware = hardware
        self._publisher = node.create_publisher(DiagnosticArray, '/diagnostics', 10)
        call_every(node, _PERIOD_S, self.publish)

    def publish(self) -> None:
        """Publish the present state."""
        level, text, values = self._health()
        if failed := failures(self._node):
            values = {**values, **{f'{name}.failed': count for name, count in failed.items()}}
            text = f'{text}; handlers failed: {", ".join(sorted(failed))}'
            level = max(level, DiagnosticStatus.WARN)
        status = DiagnosticStatus(
            level=level,
            name=f'{self._node.get_fully_qualified_name()}: state',
            message=text,
            hardware_id=self._hardware,
            values=[KeyValue(key=key, value=str(value)) for key, value in values.items()],
        )
        stamp = self._node.get_clock().now().to_msg()
        array = DiagnosticArray(status=[status])
        array.header.stamp = stamp
        self._publisher.publish(array)
