# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A peer that sends well-typed messages, requests and parameters of hostile values, by a seed."""

from __future__ import annotations

import copy
import time
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import rclpy
from hexapod_interfaces.action import TrainRun
from rcl_interfaces.msg import ParameterType
from rcl_interfaces.srv import (
    GetParameters,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.client import Client
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, qos_profile_sensor_data
from rclpy.task import Future
from unique_identifier_msgs.msg import UUID

from .hostile_values import HostileValues, import_class, service_class

# What would end a node, or its part in the graph, by its own right.
SPARED_TRANSITIONS = (5, 6, 7)
_UNANSWERED = 3000
_PACE = 100
_TURN_S = 0.001


class Hostile:
    """Sends to whatever the graph shows, and listens to all of it.

    Attributes:
        sent: Messages by topic.
        asked: Requests by service.
        answered: How many of them were answered.
        quoted: What it heard that holds the secret.
    """

    def __init__(self, domain: int, seed: int, paths: Sequence[str], secret: str) -> None:
        """Join the graph.

        Args:
            domain: of the graph.
            seed: of everything that it does.
            paths: to name where a request takes one.
            secret: what no message may hold.
        """
        self.sent: Counter[str] = Counter()
        self.asked: Counter[str] = Counter()
        self.answered = 0
        self.quoted: list[str] = []
        self._random = np.random.default_rng(seed)
        self._values = HostileValues(self._random, paths)
        self._secret = secret
        self._context = rclpy.Context()
        rclpy.init(context=self._context, domain_id=domain)
        self.node = Node('hostile', context=self._context, start_parameter_services=False)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._clients: dict[str, Client] = {}
        self._publishers: dict[str, Any] = {}
        self._seen: dict[str, Any] = {}
        self._pending: list[tuple[Client, Future]] = []

    def close(self) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.shutdown()

    # The graph

    def nodes(self) -> list[str]:
        """Return the fully qualified names of the others."""
        found = self.node.get_node_names_and_namespaces()
        names = {f'{space.rstrip("/")}/{name}' for name, space in found if name != 'hostile'}
        return sorted(name for name in names if not name.split('/')[-1].startswith('_'))

    def spin(self, seconds: float) -> None:
        """Take in what comes for a while."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            # The same limit always: at another one rclpy begins its round of what is ready anew,
            # and comes to no answer while there are topics.
            self._executor.spin_once(timeout_sec=_TURN_S)

    def answers(self, node: str, timeout_s: float = 60.0) -> bool:
        """Whether a node answers a plain question."""
        client = self._client(f'{node}/get_parameters', GetParameters)
        if not client.wait_for_service(timeout_s):
            return False
        answer = client.call_async(GetParameters.Request(names=['use_sim_time']))
        self._executor.spin_until_future_complete(answer, timeout_s)
        return bool(answer.done() and answer.result().values)

    def _topics(self) -> list[tuple[str, str]]:
        return [
            (name, types[0])
            for name, types in self.node.get_topic_names_and_types()
            if name not in ('/rosout', '/parameter_events')
            and any(
                i.node_name != 'hostile' for i in self.node.get_subscriptions_info_by_topic(name)
            )
        ]

    def _heard(self, topic: str) -> bool:
        listeners = self.node.get_subscriptions_info_by_topic(topic)
        return any(listener.node_name != 'hostile' for listener in listeners)

    def _services(self) -> list[tuple[str, str]]:
        found = self.node.get_service_names_and_types()
        return [(name, types[0]) for name, types in found if not name.startswith('/hostile/')]

    # What is sent

    def begin_run(self, action: str, goal: TrainRun.Goal) -> None:
        """Have a worker begin a run, if it is free: some topics are heard only then."""
        client = self._client(f'{action}/_action/send_goal', TrainRun.Impl.SendGoalService)
        identity = UUID(uuid=self._random.integers(0, 256, 16, dtype=np.uint8))
        request = TrainRun.Impl.SendGoalService.Request(goal_id=identity, goal=goal)
        self._executor.spin_until_future_complete(client.call_async(request), 10.0)
        self.spin(1.0)

    def send_messages(self, count: int, alive: Callable[[], None]) -> None:
        """Publish so many messages, spread over all topics that anybody hears at the time."""
        for start in range(0, count, _PACE):
            topics = self._topics()
            self._listen()
            for _ in range(min(_PACE, count - start)):
                name, type_name = topics[self._random.integers(len(topics))]
                self._publisher(name, type_name).publish(self._message(name, type_name))
                self.sent[name] += 1
            self.spin(0.02)
            alive()

    def send_requests(self, count: int, alive: Callable[[], None]) -> None:
        """Send so many requests, spread over all services."""
        for number in range(count):
            if number % _PACE == 0:
                services = self._services()
                alive()
            name, type_name = services[self._random.integers(len(services))]
            kind = service_class(type_name)
            request = self._values.value(kind.Request, name)
            if type_name == 'lifecycle_msgs/srv/ChangeState':
                self._spare(request)
            self._ask(self._client(name, kind), request)
            self.spin(0.001)

    def set_parameters(self, count: int, alive: Callable[[], None]) -> None:
        """Set so many parameters of every node, known and unknown, of any type."""
        nodes = self.nodes()
        known = {node: self._parameter_names(node) for node in nodes}
        for number in range(count):
            if number % _PACE == 0:
                alive()
            node = nodes[self._random.integers(len(nodes))]
            kind, name = (
                (SetParameters, 'set_parameters'),
                (SetParametersAtomically, 'set_parameters_atomically'),
            )[number % 2]
            request = kind.Request()
            for _ in range(int(self._random.integers(1, 4))):
                parameter = self._values.value(import_class('rcl_interfaces/msg/Parameter'), node)
                if known[node] and self._random.random() < 0.7:
                    parameter.name = str(self._random.choice(known[node]))
                if self._random.random() < 0.7:
                    last = ParameterType.PARAMETER_STRING_ARRAY
                    parameter.value.type = int(self._random.integers(0, last + 1))
                if parameter.name != 'use_sim_time':  # a clock that nobody drives stops the robot
                    request.parameters.append(parameter)
            self._ask(self._client(f'{node}/{name}', kind), request)
            self.spin(0.001)

    def _parameter_names(self, node: str) -> list[str]:
        client = self._client(f'{node}/list_parameters', ListParameters)
        answer = client.call_async(ListParameters.Request())
        self._executor.spin_until_future_complete(answer, 30.0)
        return list(answer.result().result.names) if answer.done() else []

    def _spare(self, request: Any) -> None:
        transition = request.transition
        if transition.id in SPARED_TRANSITIONS:
            transition.id = 1
        if 'shutdown' in transition.label:
            transition.label = ''

    def _ask(self, client: Client, request: Any) -> None:
        self.asked[client.service_name] += 1
        self._pending.append((client, client.call_async(request)))
        self.collect()

    def collect(self) -> None:
        """Read the answers that have come, and give up the oldest that have not."""
        waiting = []
        for client, answer in self._pending:
            if answer.done():
                self.answered += 1
                self._hear(client.service_name, answer.result())
            else:
                waiting.append((client, answer))
        for client, answer in waiting[:-_UNANSWERED]:
            client.remove_pending_request(answer)
        self._pending = waiting[-_UNANSWERED:]

    def settle(self, longest_s: float = 30.0) -> None:
        """Wait for answers until none come any more."""
        end, silent = time.monotonic() + longest_s, 0
        while self._pending and silent < 3 and time.monotonic() < end:
            before = self.answered
            self.spin(2.0)
            self.collect()
            silent = silent + 1 if self.answered == before else 0

    def unanswered(self) -> Counter[str]:
        """Return how many requests wait for an answer, by service."""
        return Counter(client.service_name for client, _ in self._pending)

    def tally(self) -> str:
        """Say what was sent so far."""
        return (
            f'{sum(self.sent.values())} messages on {len(self.sent)} topics, '
            f'{sum(self.asked.values())} requests to {len(self.asked)} services, '
            f'{self.answered} answered'
        )

    def _client(self, name: str, kind: type) -> Client:
        if name not in self._clients:
            # By default a client keeps ten answers, and this one reads slower than nodes answer.
            keep = QoSProfile(depth=1000)
            self._clients[name] = self.node.create_client(kind, name, qos_profile=keep)
            self._clients[name].wait_for_service(2.0)
        return self._clients[name]

    def _publisher(self, name: str, type_name: str) -> Any:
        if name not in self._publishers:
            kind = import_class(type_name)
            self._publishers[name] = self.node.create_publisher(kind, name, QoSProfile(depth=1000))
            self._until_matched(self._publishers[name])
        return self._publishers[name]

    def _until_matched(self, publisher: Any) -> None:
        end = time.monotonic() + 1.0
        while not publisher.get_subscription_count() and time.monotonic() < end:
            self.spin(0.01)

    def _listen(self) -> None:
        """Subscribe to what anybody publishes, for a good message to spoil, and for the secret."""
        for name, types in self.node.get_topic_names_and_types():
            if name not in self._seen and self.node.count_publishers(name):
                self._seen[name] = None
                kind = import_class(types[0])
                self.node.create_subscription(
                    kind, name, lambda m, n=name: self._hear(n, m), qos_profile_sensor_data
                )

    def _hear(self, name: str, message: Any) -> None:
        if name in self._seen:
            self._seen[name] = message
        if self._secret in str(message):
            self.quoted.append(f'{name}: {message}'[:500])

    def _message(self, name: str, type_name: str) -> Any:
        """Return a good message with some values spoilt, or one that is made up."""
        good = self._seen.get(name)
        if good is None or self._random.random() < 0.3:
            return self._values.value(import_class(type_name), name)
        message = copy.deepcopy(good)
        for _ in range(int(self._random.integers(0, 3))):
            self._spoil(message)
        return message

    def _spoil(self, message: Any) -> None:
        fields = message.get_fields_and_field_types()
        name = str(self._random.choice(list(fields)))
        inner = getattr(message, name)
        if hasattr(inner, 'get_fields_and_field_types') and self._random.random() < 0.8:
            self._spoil(inner)
        else:
            setattr(message, name, self._values.field(fields[name], name))
