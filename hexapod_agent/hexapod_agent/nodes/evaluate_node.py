# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `evaluation`: has a worker play a checkpoint, and measures the episodes by the topics."""

import os
import time
from collections import defaultdict, deque
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import yaml
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_interfaces.action import TrainRun
from hexapod_interfaces.msg import StepOutcome
from hexapod_node.actions import ActionClient
from hexapod_node.coroutines import start, until, until_lost, until_true
from hexapod_node.matching import unmatched
from hexapod_node.node import Node
from hexapod_node.qos import LOCK_STEP
from hexapod_node.raw_topics import message_class
from hexapod_node.root import root_arguments
from hexapod_node.spin import serving, spin_once
from hexapod_node.stamps import to_nanoseconds
from hexapod_sim.nodes.sim_node import SimNode
from hexapod_sim.sensor_table import CHANNELS
from nav_msgs.msg import Odometry
from rclpy.executors import Executor
from rclpy.task import Future

from hexapod_agent.environment.evaluation import Episode, EpisodeMeter, GraphError
from hexapod_agent.nodes.action_names import PLAY_RUN
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_agent.nodes.messages import decode, outcome_from_message
from hexapod_agent.specification.spec_text import merged

_MEASURED = ('joint_velocities', 'joint_torques', 'line_offset')
_CHANNELS = tuple(c for c in CHANNELS if not set(_MEASURED).isdisjoint(c.readings))
_TOPICS = {topic: message_class(c.message_type) for c in _CHANNELS for topic in c.topics} | {
    'odom': Odometry,
    'step_outcome': StepOutcome,
}
_POLL_S = 0.02
_READY_S = 30.0
_DRAIN_S = 10.0


class EvaluationNode(Node):
    """Hears what the sim publishes and reduces it to episodes.

    Attributes:
        episodes: The complete ones, in their order; take them from the left.
    """

    def __init__(self) -> None:
        super().__init__('evaluation')
        self.episodes: deque[Episode] = deque()
        self._samples: defaultdict[int, dict[str, Any]] = defaultdict(dict)
        self._meter = EpisodeMeter(0.0)
        for topic, kind in _TOPICS.items():
            self.create_subscription(kind, topic, partial(self._on_sample, topic), LOCK_STEP)
        self._client = ActionClient(self, TrainRun, PLAY_RUN)

    async def play(self, goal: TrainRun.Goal, sim: SimNode, timeout_s: float = _READY_S) -> None:
        """Have the agent play, once everything that the sim publishes is heard here.

        Raises:
            GraphError: no agent is there within the time, or the sim is not heard; the agent
                refused the goal, ended it early, or was lost.
        """
        listeners = {self.resolve_topic_name(topic): 1 for topic in _TOPICS}
        if not await until_true(self, lambda: not unmatched(sim.publishers, listeners), timeout_s):
            fault = unmatched(sim.publishers, listeners)
            raise GraphError(f'{fault} after {timeout_s:g} s, expected that of this node')
        if not await until_true(self, self._client.server_is_ready, timeout_s):
            action = self.resolve_topic_name(PLAY_RUN)
            raise GraphError(f'action {action}: no server within {timeout_s:g} s, expected agent')
        handle = await until(self._client.send_goal_async(goal))
        if not handle.accepted:
            raise GraphError('the agent refused the run, expected it to be free')
        played = handle.get_result_async()
        if not await until_lost(self, played, self._client.server_is_ready, timeout_s):
            raise GraphError(f'the agent was lost amid the run, not seen for {timeout_s:g} s')
        response = played.result()
        if response.result.message:
            raise GraphError(response.result.message)

    def _on_sample(self, topic: str, message: Any) -> None:
        """Take a control period when its last topic comes; each topic keeps its order."""
        stamp = to_nanoseconds(message.header.stamp)
        self._samples[stamp][topic] = message
        if len(self._samples[stamp]) == len(_TOPICS):
            self._on_period(self._samples.pop(stamp))

    def _on_period(self, messages: dict[str, Any]) -> None:
        outcome = outcome_from_message(messages['step_outcome'])
        x = float(messages['odom'].pose.pose.position.x)
        if not outcome.step:
            self._meter = EpisodeMeter(x)
            return
        readings: dict[str, Any] = {}
        for channel in _CHANNELS:
            readings |= decode(channel, messages)
        offset = float(readings['line_offset'][0])
        torques, velocities = readings['joint_torques'], readings['joint_velocities']
        self._meter.add(outcome.reward, offset, x, torques, velocities)
        if outcome.terminated or outcome.truncated:
            self.episodes.append(self._meter.episode(outcome.terminated))


def episodes_on_graph(
    checkpoint: Path, starts: int, seed: int, changes: Mapping[str, Any]
) -> Iterator[Episode]:
    """Start sim, cpg and agent in a namespace of their own, and yield the episodes they play.

    Args:
        checkpoint: What is played.
        starts: How many episodes.
        seed: Of their starts.
        changes: Of the checkpoint's specification, as nested values.

    Raises:
        GraphError: the run ended early, or an episode did not arrive whole.
    """
    goal = TrainRun.Goal(
        run_id='evaluation',
        checkpoint=str(checkpoint.resolve()),
        spec=yaml.safe_dump(merged(changes, {'training': {'episodes': starts}})),
        seed=seed,
    )
    namespace, files = f'/evaluate_{os.getpid()}', root_arguments('', checkpoint.resolve())
    with serving(_make_nodes, namespace, files) as (executor, (sim, _, _, node)):
        played = start(node.play(goal, sim))
        for count in range(starts):
            if not _spin_until_heard(executor, node, played):
                raise GraphError(f'{count} of {starts} episodes arrived whole, expected all')
            yield node.episodes.popleft()
        while not played.done():  # or the agent would be stopped amid its last words
            spin_once(executor, _POLL_S)


def _make_nodes() -> tuple[SimNode, CpgNode, AgentNode, EvaluationNode]:
    """Make a worker without recorder, and who evaluates it."""
    return SimNode(), CpgNode(), AgentNode(action=PLAY_RUN), EvaluationNode()


def _spin_until_heard(executor: Executor, node: EvaluationNode, played: Future) -> bool:
    """Serve the nodes until the next episode is there; False if the run ended without it."""
    ended_at = None
    while not node.episodes:
        spin_once(executor, _POLL_S)
        if played.done():
            played.result()
            ended_at = ended_at or time.monotonic()
            if time.monotonic() - ended_at > _DRAIN_S:
                return False
    return True
