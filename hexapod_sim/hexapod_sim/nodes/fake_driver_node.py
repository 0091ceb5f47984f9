# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `fake_driver`: republishes one channel of the sim as a device of its own would."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.node import Node
from hexapod_node.parameters import Parameter, config_table, declare
from hexapod_node.qos import DRIVER, LOCK_STEP
from hexapod_node.raw_topics import message_class
from hexapod_node.spin import run
from hexapod_node.stamps import time_message, to_nanoseconds
from hexapod_node.sync import LOCKSTEP, REALTIME
from hexapod_node.timers import call_every
from rclpy.parameter import Parameter as RclpyParameter
from rclpy.publisher import Publisher
from rclpy.serialization import serialize_message

from hexapod_sim.fake_device import (
    DEVICES,
    OUR_ORDER,
    REVERSED,
    SHUFFLED,
    STALE_STAMPS,
    STOPPED,
    FakeDevice,
    fault_names,
)
from hexapod_sim.quality import PERFECT

_FLUSH_PERIOD_S = 0.005

PARAMETERS = (
    Parameter('channel', 'imu/data', 'what the device measures', choices=tuple(DEVICES)),
    Parameter('topic', '', 'its own topic; empty: driver/<channel>'),
    Parameter('frame', '', "its own frame, with _<leg> of load cells; empty: the sim's"),
    Parameter(
        'sync',
        REALTIME,
        'realtime: best effort, samples come when they come; lockstep: reliable, one per period, '
        'the last one again where a sample is late, lost or left out',
        choices=(LOCKSTEP, REALTIME),
    ),
    Parameter('seed', 1, 'seed of all that is random', range=(0, 2**63 - 1)),
    *(
        replace(entry, name=entry.name.removeprefix('quality.'), read_only=True)
        for entry in config_table(PERFECT, 'quality')
    ),
    Parameter(
        'joint_order',
        OUR_ORDER,
        'order of the joints in its arrays',
        choices=(OUR_ORDER, REVERSED, SHUFFLED),
    ),
    Parameter('joint_prefix', '', 'what it puts before the names of the joints'),
    Parameter('extra_joints', 0, 'joints that are not ours, with joint_order shuffled',
              range=(0, 100)),
)  # fmt: skip


@dataclass
class _Outlet:
    """One topic of the device."""

    topic: str
    """Of the sim."""
    publisher: Publisher
    stale: Time | None = None
    """The stamp that stands still."""
    unheard: bytes = b''
    """The newest message that had no subscription to go to."""


class FakeDriverNode(Node):
    """Stands in for one device of a real robot, on the machine of the sim."""

    def __init__(
        self, name: str = 'fake_driver', parameter_overrides: Sequence[RclpyParameter] = ()
    ) -> None:
        """Subscribe to the sim's topics of the channel.

        Args:
            name: Of the node.
            parameter_overrides: Values that stand in for the command line's.

        Raises:
            ValueError: A parameter does not suit the channel.
        """
        super().__init__(name, parameter_overrides=list(parameter_overrides))
        declare(self, PARAMETERS)
        value: dict[str, Any] = {p.name: self.get_parameter(p.name).value for p in PARAMETERS}
        self._device = FakeDevice(value)
        text = 'what is wrong with it; settable while it runs; the channel decides on the choices'
        faults = ('', *fault_names(self._device.row))
        declare(self, [Parameter('fault', '', text, choices=faults, read_only=False)])
        self._received = self._published = 0
        self._lock_step = value['sync'] == LOCKSTEP
        qos = LOCK_STEP if self._lock_step else DRIVER
        self._outlets = []
        kind = message_class(self._device.row.message_type)
        for topic in self._device.row.topics:
            publisher = self.create_publisher(kind, self._device.own_topic(topic), qos)
            outlet = _Outlet(topic, publisher)
            self.create_subscription(kind, topic, partial(self._on_sample, outlet), qos)
            self._outlets.append(outlet)
        if self._lock_step:
            call_every(self, _FLUSH_PERIOD_S, self._flush)
        Diagnostics(self, self._health, hardware=f'fake {value["channel"]}')

    @property
    def _fault(self) -> str:
        return str(self.get_parameter('fault').value)

    def _on_sample(self, outlet: _Outlet, message: Any) -> None:
        """Take a sample of the sim, and publish what the device has delivered by then."""
        self._received += 1
        stamp_ns = to_nanoseconds(message.header.stamp)
        arrived = self._device.measure(message, outlet.topic, stamp_ns)
        fault = self._fault
        if fault == STOPPED or not (arrived or self._lock_step):
            return
        self._device.fill(message, outlet.topic, fault)
        if not self._lock_step:
            message.header.stamp = time_message(self._device.lines[outlet.topic].stamp_ns)
        outlet.stale = (outlet.stale or message.header.stamp) if fault == STALE_STAMPS else None
        message.header.stamp = outlet.stale or message.header.stamp
        self._published += 1
        if self._lock_step and not outlet.publisher.get_subscription_count():
            outlet.unheard = serialize_message(message)
        else:
            outlet.publisher.publish(message)

    def _flush(self) -> None:
        """Publish what nobody was there to hear: in lock-step no sample may be lost."""
        for outlet in self._outlets:
            if outlet.unheard and outlet.publisher.get_subscription_count():
                outlet.publisher.publish(outlet.unheard)
                outlet.unheard = b''

    def _health(self) -> Health:
        counts = {
            'received': self._received,
            'published': self._published,
            'lost': sum(line.lost for line in self._device.lines.values()),
        }
        if fault := self._fault:
            return DiagnosticStatus.WARN, f'fault: {fault}', counts
        return DiagnosticStatus.OK, 'republishing', counts


def main(args: Sequence[str] | None = None) -> None:
    """Run the node until a signal comes."""
    run(FakeDriverNode, args)


if __name__ == '__main__':
    main()
