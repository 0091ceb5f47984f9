# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `fake_driver`: republishes one channel of the sim as a device of its own would."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.node import Node
from hexapod_node.parameters import Parameter, declare
from hexapod_node.qos import DRIVER, LOCK_STEP
from hexapod_node.raw_topics import message_class
from hexapod_node.spin import run
from hexapod_node.stamps import time_message, to_nanoseconds
from hexapod_node.sync import LOCKSTEP, REALTIME
from hexapod_node.timers import call_every
from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter as RclpyParameter
from rclpy.publisher import Publisher
from rclpy.serialization import serialize_message

from hexapod_sim.driver_faults import ALL_FAULTS, DEVICES, STALE_STAMPS, STOPPED
from hexapod_sim.fake_device import OUR_ORDER, REVERSED, SHUFFLED, FakeDevice
from hexapod_sim.sample_line import SampleLine, Timing

_UNIT = 'SI unit of the channel'
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
    Parameter(
        'noise',
        0.0,
        'standard deviation of each sample; orientation: rad; contacts: chance to be wrong',
        unit=_UNIT,
        range=(0.0, 1e3),
    ),
    Parameter(
        'bias',
        0.0,
        'standard deviation of the constant error of each number',
        unit=_UNIT,
        range=(0.0, 1e3),
    ),
    Parameter(
        'quantisation', 0.0, 'step of the values; 0 for none', unit=_UNIT, range=(0.0, 1e3)
    ),
    Parameter(
        'velocity_noise', 0.0, 'noise of the joint velocities', unit='rad/s', range=(0.0, 1e3)
    ),
    Parameter(
        'velocity_bias', 0.0, 'bias of the joint velocities', unit='rad/s', range=(0.0, 1e3)
    ),
    Parameter(
        'velocity_quantisation',
        0.0,
        'step of the joint velocities; 0 for none',
        unit='rad/s',
        range=(0.0, 1e3),
    ),
    Parameter('delay', 0.0, 'from measurement to delivery', unit='s', range=(0.0, 10.0)),
    Parameter('dropout', 0.0, 'chance of a sample to be lost', range=(0.0, 0.999)),
    Parameter('rate', 0.0, "samples per second; 0 for the sim's", unit='Hz', range=(0.0, 1e3)),
    Parameter(
        'joint_order',
        OUR_ORDER,
        'order of the joints in its arrays',
        choices=(OUR_ORDER, REVERSED, SHUFFLED),
    ),
    Parameter('joint_prefix', '', 'what it puts before the names of the joints'),
    Parameter('extra_joints', 0, 'joints that are not ours, with joint_order shuffled',
              range=(0, 100)),
    Parameter(
        'fault',
        '',
        'what is wrong with it; settable while it runs, which of them depends on the channel',
        choices=('', *ALL_FAULTS),
        read_only=False,
    ),
)  # fmt: skip


@dataclass
class _Outlet:
    """One topic of the device."""

    topic: str
    """Of the sim."""
    publisher: Publisher
    line: SampleLine[Any]
    stale: Time | None = None
    """The stamp that stands still."""
    unmatched: bytes = b''
    """The newest message that had no subscription to go to."""


class FakeDriverNode(Node):
    """Stands in for one device of a real robot, on the machine of the sim."""

    def __init__(
        self, name: str = 'fake_driver', parameter_overrides: Sequence[RclpyParameter] = ()
    ) -> None:
        """Subscribe to the sim's topics of the channel.

        Args:
            name: of the node.
            parameter_overrides: values that stand in for the command line's.

        Raises:
            ValueError: a parameter does not suit the channel.
        """
        super().__init__(name, parameter_overrides=list(parameter_overrides))
        declare(self, PARAMETERS)
        value: dict[str, Any] = {p.name: self.get_parameter(p.name).value for p in PARAMETERS}
        self._device = FakeDevice(value)
        self._received = self._published = 0
        lock_step = value['sync'] == LOCKSTEP
        qos = LOCK_STEP if lock_step else DRIVER
        timing = Timing(value['delay'], value['dropout'], value['rate'], hold=lock_step)
        self._outlets = []
        kind = message_class(DEVICES[self._device.channel].message_type)
        for index, topic in enumerate(self._device.topics):
            own = self._device.own_topic(topic)
            publisher = self.create_publisher(kind, own, qos)
            # A device of six cells loses a sample of one of them, not of all.
            outlet = _Outlet(topic, publisher, SampleLine(timing, value['seed'] + index))
            self.create_subscription(kind, topic, partial(self._on_sample, outlet), qos)
            self._outlets.append(outlet)
        self.add_on_set_parameters_callback(self._on_set)
        if lock_step:
            call_every(self, _FLUSH_PERIOD_S, self._flush)
        Diagnostics(self, self._health, hardware=f'fake {self._device.channel}')

    @property
    def _fault(self) -> str:
        return str(self.get_parameter('fault').value)

    def _on_sample(self, outlet: _Outlet, message: Any) -> None:
        """Take a sample of the sim, and publish what the device delivers by then."""
        self._received += 1
        stamp_ns = to_nanoseconds(message.header.stamp)
        self._device.degrade(message, outlet.topic, stamp_ns, self._fault)
        for delivered_ns, delivered in outlet.line.offer(stamp_ns, message):
            self._publish(outlet, delivered_ns, delivered)

    def _publish(self, outlet: _Outlet, stamp_ns: int, message: Any) -> None:
        fault = self._fault
        if fault == STOPPED:
            return
        message.header.stamp = time_message(stamp_ns)
        if fault == STALE_STAMPS:
            outlet.stale = message.header.stamp = outlet.stale or message.header.stamp
        else:
            outlet.stale = None
        self._published += 1
        if outlet.line.holds and not outlet.publisher.get_subscription_count():
            outlet.unmatched = serialize_message(message)
        else:
            outlet.publisher.publish(message)

    def _flush(self) -> None:
        """Publish what nobody was there to hear: in lock-step no sample may be lost."""
        for outlet in self._outlets:
            if outlet.unmatched and outlet.publisher.get_subscription_count():
                outlet.publisher.publish(outlet.unmatched)
                outlet.unmatched = b''

    def _on_set(self, parameters: list[RclpyParameter]) -> SetParametersResult:
        """Refuse a fault that the channel cannot have."""
        try:
            for parameter in parameters:
                if parameter.name == 'fault':
                    self._device.check_fault(parameter.value)
        except ValueError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _health(self) -> Health:
        counts = {
            'received': self._received,
            'published': self._published,
            'lost': sum(outlet.line.lost for outlet in self._outlets),
        }
        if fault := self._fault:
            return DiagnosticStatus.WARN, f'fault: {fault}', counts
        return DiagnosticStatus.OK, 'republishing', counts


def main(args: Sequence[str] | None = None) -> None:
    """Run the node until a signal comes."""
    run(FakeDriverNode, args)


if __name__ == '__main__':
    main()
