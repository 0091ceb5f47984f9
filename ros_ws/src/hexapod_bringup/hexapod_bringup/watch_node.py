# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `watch`: hears the robots that somebody looks at on the page, and those alone.

Samples are taken out of the subscriptions' queues a few times a second, so that a training of
hundreds of control periods a second costs no callback for each.
"""

import math
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_agent.specification.run_spec import ConfigError, RunSpec
from hexapod_interfaces.msg import CampaignStatus, EpisodeResult
from hexapod_node.coroutines import ServiceUnavailableError, call, start
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.node import Node
from hexapod_node.parameters import config_table
from hexapod_node.qos import DRIVER, LATCHED
from hexapod_node.timers import call_every, call_later
from hexapod_sim.scenes.table import SceneConfig
from hexapod_sim.variations.table import RobotConfig
from rcl_interfaces.srv import GetParameters
from rclpy.parameter import parameter_value_to_python
from rclpy.subscription import Subscription

from hexapod_bringup.watch_sampler import TRUTH, Sampler, joined
from hexapod_bringup.watching.board import ODOMETRY, OUTCOME, Board, Robot
from hexapod_bringup.watching.records import (
    MOST_TERMS,
    outcome_record,
    pose_of,
    result_record,
    stamp_s,
)
from hexapod_bringup.watching.signals import JOINT_STATES, SIGNALS

EPISODES = 'episode_result'
_STATUS_TYPE = 'hexapod_interfaces/msg/CampaignStatus'
_MOST_ROBOTS = 64  # whoever is in the domain may publish under any name
_LOOK_PERIOD_S = 1.0
_WORLD_PERIOD_S = 5.0
_ANSWER_S = 2.0
# Samples are taken so often, and less often where that would take more than a fifth of a core.
_TAKE_PERIOD_S = 0.1
_SHARE = 5.0


class WatchNode(Node):
    """Finds robots and the campaign, and writes on the board what they publish."""

    def __init__(self, board: Board, folder: Path | None = None) -> None:
        """Begin to look.

        Args:
            board: what the page shows.
            folder: of the campaign; None for that of the manager that is found.
        """
        super().__init__('watch')
        self._board, self._sampler = board, Sampler()
        board.campaign_folder = str(folder) if folder else None
        self._follow_manager = folder is None
        self._managers: dict[str, Subscription] = {}
        self._results: dict[str, Subscription] = {}
        self._asked: dict[str, float] = {}
        self._askers: dict[str, Any] = {}
        self._measured: dict[str, tuple[float, float]] = {}
        self._unread = 0
        call_every(self, _LOOK_PERIOD_S, self._look)
        call_later(self, _TAKE_PERIOD_S, self._take)
        Diagnostics(self, self._health)

    def destroy_node(self) -> None:
        """End the subscriptions, then the node."""
        self._sampler.destroy_node()
        super().destroy_node()

    def _look(self) -> None:
        """Find robots and managers, and hear of each robot what somebody looks at."""
        topics = dict(self.get_topic_names_and_types())
        room = _MOST_ROBOTS - len(self._board.robots)
        for robot in sorted(self._robots(topics) - self._board.robots.keys())[:room]:
            with self._board.lock:
                self._board.robots[robot] = Robot(robot)
            self._results[robot] = self.create_subscription(
                EpisodeResult,
                joined(robot, EPISODES),
                lambda message, robot=robot: self._on_result(robot, message),
                DRIVER,
            )
        for name, types in topics.items():
            if self._follow_manager and _STATUS_TYPE in types and name not in self._managers:
                self._managers[name] = self.create_subscription(
                    CampaignStatus,
                    name,
                    lambda _, name=name: self._ask_manager(name),
                    LATCHED,
                )
        self._hear()

    def _robots(self, topics: Mapping[str, Any]) -> set[str]:
        """Return the robots whose joints somebody publishes, by namespace below this one."""
        own = self.get_namespace().rstrip('/') + '/'
        found = {
            name.removeprefix(own).removesuffix(f'/{JOINT_STATES}')
            for name in topics
            if name.startswith(own)
            and name.endswith(f'/{JOINT_STATES}')
            and name != f'{own}{JOINT_STATES}'
        }
        return {
            robot for robot in found | {''} if self.count_publishers(joined(robot, JOINT_STATES))
        }

    def _hear(self) -> None:
        """Subscribe to what is looked at: what the agent hears, or every sensor."""
        wanted: set[tuple[str, str]] = set()
        for robot, every in self._board.watched().items():
            if robot not in self._board.robots:
                continue
            heard = tuple(topic for topic in SIGNALS if self._is_heard(robot, topic))
            with self._board.lock:
                self._board.robots[robot].heard = heard
            topics = {*(SIGNALS if every else heard), JOINT_STATES, *TRUTH}
            wanted |= {(robot, topic) for topic in topics}
            self._ask_sim(robot)
        self._sampler.hear(wanted)

    def _is_heard(self, robot: str, topic: str) -> bool:
        """Whether a node other than the watch listens to a topic."""
        listeners = self.get_subscriptions_info_by_topic(
            self.resolve_topic_name(joined(robot, topic))
        )
        return any(end.node_name != self._sampler.get_name() for end in listeners)

    def _take(self) -> None:
        """Write down what has come, and come again."""
        began = time.monotonic()
        for robot, topic, messages in self._sampler.take():
            with self._board.lock:
                self._write(self._board.robots[robot], topic, messages)
        took = time.monotonic() - began
        call_later(self, max(_TAKE_PERIOD_S, _SHARE * took), self._take)

    def _write(self, robot: Robot, topic: str, messages: list[Any]) -> None:
        if topic == ODOMETRY:
            robot.pose = pose_of(messages[-1])
        elif topic == OUTCOME:
            self._measure(robot, stamp_s(messages[-1]))
            robot.outcome = outcome_record(messages[-1])
            for message in messages:
                values = [*message.term_values[:MOST_TERMS], message.reward]
                robot.track(OUTCOME).add(stamp_s(message), values)
        else:
            for message in messages:
                try:
                    values = SIGNALS[topic].read(message)
                except ValueError:  # of another robot, or a broken driver
                    self._unread += 1
                else:
                    robot.track(topic).add(stamp_s(message), values)

    def _measure(self, robot: Robot, simulated_s: float) -> None:
        """Tell how fast simulated time passes, over a second at least."""
        now = time.monotonic()
        since, before = self._measured.setdefault(robot.name, (now, simulated_s))
        if now - since >= 1.0 or simulated_s < before:
            robot.speed = max(simulated_s - before, 0.0) / max(now - since, 1e-3)
            self._measured[robot.name] = now, simulated_s

    def _on_result(self, robot: str, message: EpisodeResult) -> None:
        with self._board.lock:
            self._board.robots[robot].add_episode(result_record(message))

    def _ask_sim(self, robot: str) -> None:
        """Ask what the robot and its ground are, every few seconds."""
        if time.monotonic() - self._asked.get(robot, -math.inf) >= _WORLD_PERIOD_S:
            self._asked[robot] = time.monotonic()
            start(self._learn_world(robot))

    async def _learn_world(self, robot: str) -> None:
        tables = {
            'scene': config_table(SceneConfig.of_article(), 'scene'),
            'robot': config_table(RobotConfig.of_article(), 'robot'),
        }
        names = [parameter.name for table in tables.values() for parameter in table]
        service = joined(robot, 'sim')
        found = await self._ask_parameters(service, names)
        if not found:
            return
        values: dict[str, dict[str, Any]] = {'scene': {}, 'robot': {}}
        for name, value in found.items():
            section, _, key = name.partition('.')
            values[section][key] = value
        try:
            world = RunSpec.load().changed(values, service).world
        except ConfigError:  # a sim of another version, or whoever says to be one
            return
        with self._board.lock:
            self._board.robots[robot].world = world

    def _ask_manager(self, topic: str) -> None:
        start(self._learn_folder(topic.rpartition('/')[0]))

    async def _learn_folder(self, manager: str) -> None:
        plan = (await self._ask_parameters(manager, ['plan'])).get('plan')
        if plan and (folder := Path(plan).expanduser().resolve().parent).is_dir():
            with self._board.lock:
                self._board.campaign_folder = str(folder)

    async def _ask_parameters(self, node: str, names: list[str]) -> dict[str, Any]:
        """Return a node's parameters; none where it does not answer, or lacks one."""
        service = f'{node}/get_parameters'
        if service not in self._askers:
            self._askers[service] = self.create_client(GetParameters, service)
        try:
            answer = await call(
                self, self._askers[service], GetParameters.Request(names=names), _ANSWER_S
            )
        except ServiceUnavailableError:
            return {}
        values = [parameter_value_to_python(value) for value in answer.values]
        complete = len(values) == len(names) and None not in values
        return dict(zip(names, values, strict=True)) if complete else {}

    def _health(self) -> Health:
        watched = self._board.watched()
        values = {
            'robots': len(self._board.robots),
            'watched': ', '.join(watched),
            'subscriptions': self._sampler.count,
            'unread': self._unread,
        }
        return DiagnosticStatus.OK, 'watching' if watched else 'nobody looks', values
