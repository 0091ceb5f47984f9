# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the tests of live nodes share: a context per test, an executor, and bounded waits."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import rclpy
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_interfaces.action import TrainRun
from hexapod_node.root import root_arguments
from hexapod_node.spin import spin_once
from rclpy.action import ActionClient
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.task import Future


class Graph:
    """Nodes of a test, spun only while the test waits for something."""

    def __init__(self) -> None:
        self.executor = EventsExecutor()
        self.nodes: list[Node] = []

    def add(self, *nodes: Node) -> Node:
        """Serve nodes until the test is over; return the first."""
        for node in nodes:
            self.nodes.append(node)
            self.executor.add_node(node)
        return nodes[0]

    def until(self, predicate: Callable[[], bool], timeout_s: float = 30.0) -> None:
        """Spin until the predicate holds."""
        deadline = time.monotonic() + timeout_s
        while not predicate():
            assert time.monotonic() < deadline, f'not within {timeout_s:g} s'
            spin_once(self.executor, 0.05)

    def result(self, future: Future, timeout_s: float = 30.0) -> object:
        """Spin until a future is done and return its result."""
        self.until(future.done, timeout_s)
        return future.result()

    def call(self, service: type, name: str, request: object) -> object:
        """Call a service and return its response."""
        client = self.nodes[0].create_client(service, name)
        self.until(client.service_is_ready)
        return self.result(client.call_async(request))

    def train(self, goal: TrainRun.Goal, action: str = 'train_run', timeout_s: float = 60.0):
        """Send a goal, wait for its end and return the result response."""
        client = ActionClient(self.nodes[0], TrainRun, action)
        try:
            self.until(client.server_is_ready)
            handle = self.result(client.send_goal_async(goal))
            assert handle.accepted
            return self.result(handle.get_result_async(), timeout_s)
        finally:
            client.destroy()


@pytest.fixture
def spec() -> Callable[..., str]:
    """Return a function that gives the text of a specification."""

    def make(observations: str = '', episodes: int = 1, config: Path | str | None = None) -> str:
        made = RunSpec.load(config, [f'training.episodes={episodes}'])
        return made.observing(observations).to_text()

    return make


@pytest.fixture
def ros_args() -> list[str]:
    """Return the arguments that every node of the test gets; a module may have its own."""
    return ['--ros-args']


@pytest.fixture
def graph(ros_args: list[str], tmp_path: Path) -> Iterator[Graph]:
    """Yield a graph with one helper node; everything in it ends with the test.

    Requests may name what is below the test's folder.
    """
    rclpy.init(args=[*ros_args, *root_arguments(tmp_path)])
    made = Graph()
    made.add(Node('test'))
    yield made
    made.executor.shutdown()
    for node in reversed(made.nodes):
        node.destroy_node()
    rclpy.shutdown()
