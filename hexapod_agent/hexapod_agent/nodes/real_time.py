# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A trained agent on a robot's graph, in real time: one command per tick of the clock."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_cpg.nodes.messages import command_to_message
from hexapod_interfaces.msg import CpgCommand
from hexapod_node.coroutines import ServiceUnavailableError, call, sleep, until_true
from hexapod_node.invalid_message import InvalidMessageError
from hexapod_node.newest import Input, NewestSamples
from hexapod_node.parameters import Parameter, to_messages
from hexapod_node.qos import COMMAND
from hexapod_node.raw_topics import message_class
from hexapod_node.stamps import time_message
from hexapod_node.sync import max_age, phase
from hexapod_node.ticker import Tick, Ticker
from hexapod_sim.channel import Channel
from hexapod_sim.robot import CONTROL_PERIOD_NS
from hexapod_sim.sensor_table import CHANNELS
from rcl_interfaces.srv import SetParametersAtomically

from hexapod_agent.contract.limits import Limits, parse_frames
from hexapod_agent.contract.watch import MessageWatch
from hexapod_agent.deployment.deployed_agent import DeployedAgent
from hexapod_agent.nodes.contract_check import listen_and_check
from hexapod_agent.nodes.messages import decode

if TYPE_CHECKING:
    from hexapod_node.diagnostics import Health
    from rclpy.node import Node

_ANSWER_S = 2.0
_RETRY_S = 1.0
_THROTTLE_S = 1.0


def age_name(channel: Channel) -> str:
    """Return the parameter that says how old a sample of a channel may be."""
    return f'max_age.{channel.key}'


_HEARD = tuple(channel for channel in CHANNELS if channel.topics)
PARAMETERS: tuple[Parameter, ...] = (
    phase(0.005),
    Parameter(
        'check_seconds',
        1.0,
        'realtime: how long to check the sensors before the robot moves; 0 for no check',
        unit='s',
        range=(0.0, 60.0),
    ),
    Parameter(
        'frames',
        '',
        'realtime: frames of drivers whose axes are ours, as <topic>=<frame>, separated by spaces',
    ),
    *(max_age(age_name(channel), channel.name) for channel in _HEARD),
)


class State(StrEnum):
    """What the agent does."""

    WAITING = 'waiting'
    """for the pattern generator, for samples, or for the check of the sensors"""
    REFUSED = 'refused'
    """does not drive with these sensors; checks them again"""
    DRIVING = 'driving'
    HOLDING = 'holding'
    """gives no commands, so that the pattern generator brings the robot to a stop"""


class RealTimePlay:
    """Drives the robot whenever each channel has a good sample that is young enough."""

    def __init__(self, node: Node, agent: DeployedAgent) -> None:
        """Subscribe to the agent's channels and to nothing else.

        Args:
            node: with `PARAMETERS` declared.
            agent: that drives.
        """
        self.state = State.WAITING
        self._node = node
        self._agent = agent
        self._reason = ''
        self._rejected = self._holds = 0
        self._command = CpgCommand()
        self._publisher = node.create_publisher(CpgCommand, 'cpg/command', COMMAND)
        self._cpg = node.create_client(SetParametersAtomically, 'cpg/set_parameters_atomically')
        self._limits = self._sensor_limits()
        self._samples = NewestSamples(node, self._inputs())
        self._ticker: Ticker | None = None

    async def begin(self) -> None:
        """Get the pattern generator and every channel ready, then tick.

        Raises:
            RuntimeError: the pattern generator refuses the agent's configuration.
        """
        await self._configure_cpg()
        await self._check_sensors()
        while not await until_true(self._node, lambda: not self._samples.fault(), _RETRY_S):
            self._say(self._samples.fault())
        phase_ns = round(self._node.get_parameter('phase').value * 1e9)
        self._ticker = Ticker(self._node, CONTROL_PERIOD_NS, self._on_tick, phase_ns)

    def health(self) -> Health:
        """Return what the diagnostics show."""
        values: dict[str, object] = {
            'state': str(self.state),
            'observations': self._agent.spec.letters,
            'rejected': self._rejected,
            'holds': self._holds,
        }
        values |= self._ticker.meter.values() if self._ticker is not None else {}
        values |= self._samples.values()
        if self.state is State.DRIVING:
            contest = self._samples.contest()
            level = DiagnosticStatus.WARN if contest else DiagnosticStatus.OK
            return level, contest or 'driving', values
        level = DiagnosticStatus.WARN if self.state is State.WAITING else DiagnosticStatus.ERROR
        return level, self._reason, values

    def _sensor_limits(self) -> Limits:
        value = {p.name: self._node.get_parameter(p.name).value for p in PARAMETERS}
        ages = {topic: value[age_name(channel)] for channel in _HEARD for topic in channel.topics}
        return Limits(ages=ages, frames=parse_frames(value['frames']))

    def _inputs(self) -> dict[str, Input]:
        return {
            topic: Input(
                message_class(channel.message_type),
                round(self._node.get_parameter(age_name(channel)).value * 1e9),
                _checked(channel, MessageWatch(channel, topic, self._limits)),
            )
            for channel in self._agent.spec.channels
            for topic in channel.topics
        }

    async def _configure_cpg(self) -> None:
        """Give the pattern generator the oscillators that the agent was trained with."""
        oscillators = asdict(self._agent.config.cpg.hopf)
        request = SetParametersAtomically.Request(parameters=to_messages('cpg', oscillators))
        while True:
            try:
                response = await call(self._node, self._cpg, request, _ANSWER_S)
            except ServiceUnavailableError as error:
                self._say(str(error))
                await sleep(self._node, _RETRY_S)
                continue
            if not response.result.successful:
                raise RuntimeError(f'{self._cpg.service_name}: {response.result.reason}')
            return

    async def _check_sensors(self) -> None:
        """Wait until the sensors keep the contract, and say what is wrong while they do not."""
        seconds = self._node.get_parameter('check_seconds').value
        while seconds:
            spec = self._agent.spec
            report = await listen_and_check(self._node, spec, seconds, self._limits)
            if report.passed:
                self.state = State.WAITING
                return
            self.state = State.REFUSED
            if report.refusal != self._reason:
                self._reason = report.refusal
                self._node.get_logger().error(f'does not drive:\n{report.refusal}')

    def _on_tick(self, tick: Tick) -> None:
        """Act on the newest samples, or hold."""
        messages = self._samples.take()
        if messages is None:
            self._hold(self._samples.fault())
            return
        readings: dict[str, Any] = {}
        for channel in self._agent.spec.channels:
            if channel.topics:
                readings |= decode(channel, messages)
        try:
            command = self._agent.act(readings)
        except ValueError as error:
            self._rejected += 1
            self._hold(str(error))
            return
        self._drive()
        command_to_message(command, self._command)
        self._command.header.stamp = time_message(tick.stamp_ns)
        self._publisher.publish(self._command)

    def _drive(self) -> None:
        if self.state is not State.DRIVING:
            letters = self._agent.spec.letters or 'no optional channel'
            self._node.get_logger().info(f'drives, observing {letters}')
        self.state = State.DRIVING

    def _hold(self, reason: str) -> None:
        self._holds += self.state is not State.HOLDING
        self.state = State.HOLDING
        self._say(f'{reason}; the robot stops')

    def _say(self, reason: str) -> None:
        self._reason = reason
        self._node.get_logger().warning(reason, throttle_duration_sec=_THROTTLE_S)


def _checked(channel: Channel, watch: MessageWatch) -> Callable[[Any], Any]:
    """Return what lets the good messages of a topic through and raises for the others."""

    def check(message: Any) -> Any:
        finding = watch.check(message)
        if finding is not None:
            raise InvalidMessageError(finding.kind, str(finding))
        # Of a channel with several topics, each has messages of the same kind.
        decode(channel, dict.fromkeys(channel.topics, message))
        return message

    return check
