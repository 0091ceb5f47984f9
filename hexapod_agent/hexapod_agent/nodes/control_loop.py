# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The control periods of a run on the node graph: observe, command and learn in lock-step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from hexapod_cpg.mapping import ACTION_SIZE, command_from_action
from hexapod_cpg.nodes.messages import command_to_message
from hexapod_interfaces.msg import CpgCommand, StepOutcome
from hexapod_node.lock_step import LockStep
from hexapod_node.raw_topics import message_class
from hexapod_node.stamps import time_message
from hexapod_sim.robot import CONTROL_PERIOD_NS
from hexapod_sim.task import Outcome
from numpy.typing import NDArray

from hexapod_agent.learning.player import Agent
from hexapod_agent.nodes.messages import decode, outcome_from_message
from hexapod_agent.specification.run_spec import RunSpec

if TYPE_CHECKING:
    from hexapod_node.intra_process import LockStepPublisher
    from hexapod_node.stamp_gate import LockStepCounts
    from rclpy.node import Node

OUTCOME = 'step_outcome'


class ControlLoop:
    """An agent's part of every control period, subscribed to what it observes and to no more.

    Attributes:
        periods: Commands published so far.

    Args:
        node: Subscribes.
        commands: Publishes `cpg/command`.
        config: What is observed, and what an action means.
        timeout_s: Longest wait for a topic's sample.
    """

    def __init__(
        self, node: Node, commands: LockStepPublisher, config: RunSpec, timeout_s: float
    ) -> None:
        self._node, self._commands = node, commands
        self._spec, self._config = config.observed, config
        self._command = CpgCommand()
        self._action = np.zeros(ACTION_SIZE, dtype=np.float32)
        self._stamp_ns = 0
        self.periods = 0
        # The treatment: these topics and no other sensor.
        topics = {
            topic: message_class(channel.message_type)
            for channel in self._spec.channels
            for topic in channel.topics
        }
        self._lock_step = LockStep(
            node, topics | {OUTCOME: StepOutcome}, CONTROL_PERIOD_NS, timeout_s
        )

    def destroy(self) -> None:
        """Unsubscribe from every topic."""
        self._lock_step.destroy()

    @property
    def topics(self) -> list[str]:
        """Fully qualified names of what is subscribed."""
        return self._lock_step.topics

    @property
    def counts(self) -> LockStepCounts:
        """Departures from lock-step in this episode."""
        return self._lock_step.counts

    def make_ready(self) -> None:
        """Keep what comes from here on for the next episode."""
        self._lock_step.stop()
        self._lock_step.counts.reset()
        self._action = np.zeros(ACTION_SIZE, dtype=np.float32)

    async def run_episode(self, agent: Agent, start_ns: int) -> int:
        """Observe, act and learn once per period; return the stamp of the last one.

        Args:
            agent: whose episode has begun.
            start_ns: stamp of the first observation.

        Raises:
            hexapod_node.lock_step.LockStepTimeoutError: a topic stayed silent.
        """
        self.begin_episode(start_ns)
        while True:
            observation, outcome = await self.observe()
            if outcome.terminated or outcome.truncated:
                agent.end_episode(observation, outcome)
                return self._stamp_ns
            self.act(agent.observe(observation, outcome))
            agent.learn()  # while the pattern generator and the sim are at work

    def begin_episode(self, start_ns: int) -> None:
        """Expect the first observation, of so many ns."""
        self._stamp_ns = start_ns
        self._lock_step.start(start_ns)

    async def observe(self) -> tuple[NDArray[np.float32], Outcome]:
        """Return what is observed once a period is complete, and what it earned.

        Raises:
            hexapod_node.lock_step.LockStepTimeoutError: a topic stayed silent.
        """
        messages = await self._lock_step.next_period()
        return self._assembled(messages), outcome_from_message(messages[OUTCOME])

    def act(self, action: NDArray[np.float32]) -> None:
        """Have the robot do what an action says, in the period that begins."""
        self._action = action
        self._publish_command(self._stamp_ns)
        self._stamp_ns += CONTROL_PERIOD_NS
        self.periods += 1

    def listeners(self) -> dict[str, int]:
        """Return how many subscriptions each topic must have before an episode begins."""
        topics = [self._node.resolve_topic_name('joint_trajectory'), self._commands.topic_name]
        return dict.fromkeys([*topics, *self.topics], 1)

    def _assembled(self, messages: Mapping[str, Any]) -> NDArray[np.float32]:
        readings: dict[str, NDArray[Any]] = {}
        for channel in self._spec.channels:
            if channel.topics:
                readings.update(decode(channel, messages))
        return self._spec.assemble(readings, self._action)

    def _publish_command(self, stamp_ns: int) -> None:
        command = command_from_action(
            self._action, self._config.cpg.reading, self._config.cpg.ranges
        )
        command_to_message(command, self._command)
        self._command.header.stamp = time_message(stamp_ns)
        self._commands.publish(self._command)
