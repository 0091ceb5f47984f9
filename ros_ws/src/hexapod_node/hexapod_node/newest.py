# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Subscribes to topics for their newest samples, whichever quality of service drivers offer."""

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from rclpy.node import Node

from hexapod_node.qos import DRIVER
from hexapod_node.sample_gate import SampleGate
from hexapod_node.stamps import to_nanoseconds

_THROTTLE_S = 2.0


class NumberedCallback:
    """A subscription's callback for message and publication sequence number.

    rclpy tells by a callback's signature whether it wants the message's info. EventsExecutor of
    rclpy 7.1 then passes message and info as one tuple, where the other executors pass two
    arguments; `tests/graph/test_message_info.py` says when that is over.
    """

    def __init__(self, callback: Callable[[Any, int | None], None]) -> None:
        """Wrap.

        Args:
            callback: takes the message and its number, None where the middleware has none.
        """
        self._callback = callback
        parameters = [
            inspect.Parameter(name, inspect.Parameter.POSITIONAL_ONLY)
            for name in ('message', 'info')
        ]
        self.__signature__ = inspect.Signature(parameters)

    def __call__(self, *given: Any) -> None:
        """Take what an executor passes."""
        message, info = given if len(given) == 2 else given[0]
        self._callback(message, info.get('publication_sequence_number'))


@dataclass(frozen=True)
class Input:
    """A topic to hear: its type, how old a sample may be, and what a sample is worth."""

    message_type: type
    max_age_ns: int
    decode: Callable[[Any], Any]
    """Makes a value of a message; raises ValueError where it cannot."""


class NewestSamples:
    """The newest good sample of each topic, on the node's clock."""

    def __init__(
        self, node: Node, inputs: Mapping[str, Input], now_ns: Callable[[], int] | None = None
    ) -> None:
        """Subscribe.

        Args:
            node: that subscribes.
            inputs: what to hear, by topic; every message has a header.
            now_ns: the time that stamps are compared with; None for the node's clock.
        """
        self._node = node
        self._now_ns = now_ns or (lambda: node.get_clock().now().nanoseconds)
        self.gates = {
            topic: SampleGate(topic, wanted.max_age_ns, wanted.decode)
            for topic, wanted in inputs.items()
        }
        self._age_ns: dict[str, int | None] = dict.fromkeys(inputs)
        self._oldest_ns = dict.fromkeys(inputs, 0)
        self._subscriptions = [
            node.create_subscription(
                wanted.message_type,
                topic,
                NumberedCallback(partial(self._on_message, topic)),
                DRIVER,
            )
            for topic, wanted in inputs.items()
        ]

    def destroy(self) -> None:
        """Unsubscribe."""
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)

    def take(self) -> dict[str, Any] | None:
        """Return the value of each topic; None if one is too old."""
        now_ns = self._now_ns()
        values = {topic: gate.value(now_ns) for topic, gate in self.gates.items()}
        for topic, gate in self.gates.items():
            self._age_ns[topic] = age_ns = gate.age_ns(now_ns)
            self._oldest_ns[topic] = max(self._oldest_ns[topic], age_ns or 0)
        return None if any(value is None for value in values.values()) else values

    def fault(self) -> str:
        """Say which topic has no sample young enough, and why; '' if each has one."""
        now_ns = self._now_ns()
        return next((text for gate in self.gates.values() if (text := gate.fault(now_ns))), '')

    def contest(self) -> str:
        """Say which topic was heard from more than one publisher of late; '' if none was."""
        now_ns = self._now_ns()
        return next((text for gate in self.gates.values() if (text := gate.contest(now_ns))), '')

    @property
    def dropped(self) -> int:
        """Samples of any topic that were dropped."""
        return sum(gate.counts.faults for gate in self.gates.values())

    def values(self) -> dict[str, object]:
        """Return what the diagnostics show: counts, and ages when the values were taken.

        The greatest age is that since the last call.
        """
        shown: dict[str, object] = {}
        for topic, gate in self.gates.items():
            age_ns = self._age_ns[topic]
            shown[f'{topic}.age_ms'] = '' if age_ns is None else f'{age_ns * 1e-6:.1f}'
            shown[f'{topic}.age_max_ms'] = f'{self._oldest_ns[topic] * 1e-6:.1f}'
            shown |= {f'{topic}.{kind}': count for kind, count in gate.shown_counts().items()}
            self._oldest_ns[topic] = 0
        return shown

    def _on_message(self, topic: str, message: Any, sequence: int | None) -> None:
        gate = self.gates[topic]
        stamp_ns = to_nanoseconds(message.header.stamp)
        if not gate.offer(message, stamp_ns, self._now_ns(), sequence):
            self._node.get_logger().warning(
                f'sample dropped: {gate.reason}', throttle_duration_sec=_THROTTLE_S
            )
