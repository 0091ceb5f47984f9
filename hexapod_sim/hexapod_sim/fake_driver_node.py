# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `fake_driver`: republishes one channel of the sim as a device of its own would."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_interfaces.msg import LineOffset
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.parameters import Parameter, declare
from hexapod_node.qos import DRIVER, LOCK_STEP
from hexapod_node.spin import run
from hexapod_node.stamps import time_message, to_nanoseconds
from hexapod_node.sync import LOCKSTEP, REALTIME
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter as RclpyParameter
from rclpy.publisher import Publisher

from hexapod_sim.degradation import Degradation, Distortion
from hexapod_sim.driver_channels import CHANNELS, JointLayout, read, write
from hexapod_sim.driver_faults import ALL_FAULTS, STALE_STAMPS, STOPPED, fault_names, faults
from hexapod_sim.messages import SENSOR_TOPICS
from hexapod_sim.robot import JOINTS
from hexapod_sim.sample_line import SampleLine, Timing

_TYPES = {sensor.name: sensor.message_type for sensor in SENSOR_TOPICS} | {
    'line_offset': LineOffset
}
_OURS, _REVERSED, _SHUFFLED = 'ours', 'reversed', 'shuffled'
_UNIT = 'SI unit of the channel'

PARAMETERS = (
    Parameter('channel', 'imu/data', 'what the device measures', choices=tuple(CHANNELS)),
    Parameter('topic', '', 'its own topic; empty: driver/<channel>'),
    Parameter('frame', '', 'its own frame; empty: as the sim'),
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
        _OURS,
        'order of the joints in its arrays',
        choices=(_OURS, _REVERSED, _SHUFFLED),
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


class FakeDriverNode(Node):
    """Stands in for one device of a real robot, on the machine of the sim."""

    def __init__(self) -> None:
        super().__init__('fake_driver')
        declare(self, PARAMETERS)
        value: dict[str, Any] = {p.name: self.get_parameter(p.name).value for p in PARAMETERS}
        self._channel: str = value['channel']
        self._driver = CHANNELS[self._channel]
        self._frame: str = value['frame']
        self._degradations = _degradations(value)
        self._layout = _joint_layout(value)
        self._faults = faults(self._channel)
        self._stale: Time | None = None
        self._received = self._published = 0
        own = value['topic'] or f'driver/{self._channel}'
        lock_step = value['sync'] == LOCKSTEP
        timing = Timing(value['delay'], value['dropout'], value['rate'], hold=lock_step)
        self._lines: list[SampleLine[Any]] = []
        qos = LOCK_STEP if lock_step else DRIVER
        for index, topic in enumerate(self._driver.topics):
            # A device with six cells loses a sample of one of them, not of all.
            line: SampleLine[Any] = SampleLine(timing, value['seed'] + index)
            kind, name = _TYPES[topic], topic.replace(self._channel, own, 1)
            publisher = self.create_publisher(kind, name, qos)
            on_sample = partial(self._on_sample, index, line, publisher)
            self.create_subscription(kind, topic, on_sample, qos)
            self._lines.append(line)
        self._check_fault(self._fault)
        self.add_on_set_parameters_callback(self._on_set)
        Diagnostics(self, self._health, hardware=f'fake {self._channel}')

    @property
    def _fault(self) -> str:
        return str(self.get_parameter('fault').value)

    def _on_sample(
        self, index: int, line: SampleLine[Any], publisher: Publisher, message: Any
    ) -> None:
        """Take a sample of the sim, and publish what the device delivers by then."""
        self._received += 1
        stamp_ns = to_nanoseconds(message.header.stamp)
        self._degrade(message, index, stamp_ns)
        for delivered_ns, delivered in line.offer(stamp_ns, message):
            self._publish(publisher, delivered_ns, delivered)

    def _degrade(self, message: Any, index: int, stamp_ns: int) -> None:
        """Turn a message of the sim into one of the device."""
        message.header.frame_id = self._frame or message.header.frame_id
        for reading, degradation in zip(
            self._driver.readings, self._degradations[index], strict=True
        ):
            measured = degradation.apply(read(message, reading.path), stamp_ns)
            write(message, reading.path, measured)
        if self._layout is not None:
            self._layout.apply(message)
        if self._fault in self._faults:
            self._faults[self._fault](message)

    def _publish(self, publisher: Publisher, stamp_ns: int, message: Any) -> None:
        fault = self._fault
        if fault == STOPPED:
            return
        message.header.stamp = time_message(stamp_ns)
        if fault == STALE_STAMPS:
            self._stale = self._stale or message.header.stamp
            message.header.stamp = self._stale
        else:
            self._stale = None
        publisher.publish(message)
        self._published += 1

    def _on_set(self, parameters: list[RclpyParameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name == 'fault':
                try:
                    self._check_fault(parameter.value)
                except ValueError as error:
                    return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _check_fault(self, fault: str) -> None:
        """Refuse a fault that this channel cannot have.

        Raises:
            ValueError: the text says which it can have.
        """
        allowed = fault_names(self._channel)
        if fault and fault not in allowed:
            raise ValueError(
                f"fault '{fault}': {self._channel} cannot have it, expected one of "
                f'{", ".join(allowed)}'
            )

    def _health(self) -> Health:
        counts = {
            'received': self._received,
            'published': self._published,
            'lost': sum(line.lost for line in self._lines),
        }
        if self._fault:
            return DiagnosticStatus.WARN, f'fault: {self._fault}', counts
        return DiagnosticStatus.OK, 'republishing', counts


def _degradations(value: dict[str, Any]) -> list[list[Degradation]]:
    """Return what happens to each reading of each topic."""
    driver = CHANNELS[value['channel']]
    distortions = [Distortion(value['noise'], value['bias'], value['quantisation'])]
    velocity = [value[f'velocity_{name}'] for name in ('noise', 'bias', 'quantisation')]
    if len(driver.readings) > 1:
        distortions.append(Distortion(*velocity))
    elif any(velocity):
        raise ValueError(f'velocity_*: {value["channel"]} has none, expected channel joint_states')
    count = len(distortions)
    return [
        [
            Degradation(distortion, reading.kind, value['seed'], count * index + place)
            for place, (reading, distortion) in enumerate(
                zip(driver.readings, distortions, strict=True)
            )
        ]
        for index in range(len(driver.topics))
    ]


def _joint_layout(value: dict[str, Any]) -> JointLayout | None:
    """Return the device's own order and names of the joints; None where they are ours."""
    order, prefix = value['joint_order'], value['joint_prefix']
    extra = value['extra_joints']
    if not CHANNELS[value['channel']].has_joints:
        if order != _OURS or prefix or extra:
            raise ValueError(f'joint_*: {value["channel"]} has no joints')
        return None
    if extra and order != _SHUFFLED:
        raise ValueError(f'extra_joints {extra}: expected joint_order {_SHUFFLED}')
    if order == _SHUFFLED:
        return JointLayout.shuffled(len(JOINTS), extra, prefix, value['seed'])
    step = -1 if order == _REVERSED else 1
    return JointLayout(range(len(JOINTS))[::step], prefix)


def main(args: Sequence[str] | None = None) -> None:
    """Run the node until a signal comes."""
    run(FakeDriverNode, args)


if __name__ == '__main__':
    main()
