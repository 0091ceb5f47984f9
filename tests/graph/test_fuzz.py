# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Malformed messages on every subscription: no node dies, no joint target leaves its limits."""

from __future__ import annotations

import copy
from array import array
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any

import numpy as np
import pytest
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.nodes import real_time
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_agent.nodes.play_node import PlayNode
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_cpg.mapping import ActionRanges, command_from_action
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_cpg.nodes.messages import OutputMessages, command_to_message
from hexapod_interfaces.action import TrainRun
from hexapod_interfaces.msg import CpgCommand
from hexapod_interfaces.srv import ResetEpisode
from hexapod_node.sample_gate import SampleGate
from hexapod_node.stamps import time_message, to_nanoseconds
from hexapod_sim.nodes.sim_node import SimNode
from hexapod_sim.sensor_table import LETTERS
from nav_msgs.msg import Odometry
from rclpy.node import Node
from trajectory_msgs.msg import JointTrajectory

from hexapod_sim import robot

RANGES = ActionRanges.of_article()

pytestmark = pytest.mark.graph
SEED = 6
SOME = 1_500
ALL = 10_000
SMALL = {'actor': {'hidden': [16, 12]}, 'critic': {'hidden': [16, 12]}}
MAX_STEP = robot.NO_LOAD_SPEED * 0.005
COUNTS = pytest.mark.parametrize('count', [SOME, pytest.param(ALL, marks=pytest.mark.slow)])

NUMBERS = (np.nan, np.inf, -np.inf, 1e300, -1e300, 1e10)
CONTENTS = ('as it is', 'number', 'length', 'names', 'frame')
STAMPS = ('fresh', 'fresh', 'fresh', 'duplicate', 'back', 'ahead', 'old', 'zero', 'negative')
SECOND = 1_000_000_000


class MessageFuzzer:
    """Spoils copies of good messages.

    Attributes:
        made: How many of each kind there were.
    """

    def __init__(self, seed: int) -> None:
        self._random = np.random.default_rng(seed)
        self._last: dict[type, int] = {}
        self.made: Counter[str] = Counter()

    def spoil(self, good: Any, now_ns: int) -> Any:
        """Return a message that differs from a good one in contents and stamp."""
        message = copy.deepcopy(good)
        content = str(self._random.choice(CONTENTS))
        stamp = str(self._random.choice(STAMPS))
        self.made[content] += 1
        self.made[stamp] += 1
        getattr(self, f'_{content.replace(" ", "_")}')(message)
        message.header.stamp = time_message(self._stamp(stamp, type(good), now_ns))
        return message

    def _stamp(self, kind: str, of: type, now_ns: int) -> int:
        jump = int(self._random.integers(SECOND // 5, 1_000_000 * SECOND))
        stamp_ns = {
            'fresh': now_ns,
            'duplicate': self._last.get(of, now_ns),
            'back': now_ns - int(self._random.integers(1, SECOND // 50)),
            'ahead': min(now_ns + jump, (2**31 - 1) * SECOND),
            'old': max(now_ns - jump, 0),
            'zero': 0,
            'negative': -jump,
        }[kind]
        if kind == 'fresh':
            self._last[of] = stamp_ns
        return stamp_ns

    def _as_it_is(self, message: Any) -> None:
        pass

    def _frame(self, message: Any) -> None:
        message.header.frame_id = str(self._random.choice(['', 'map', 'a' * 1000, 'ü\n']))

    def _number(self, message: Any) -> None:
        leaves = list(numbers_of(message))
        if not leaves:
            return
        owner, field, kind = leaves[self._random.integers(len(leaves))]
        bad = float(self._random.choice(NUMBERS))
        if kind == 'float':  # float32 carries no more
            bad = float(np.clip(bad, -3e38, 3e38)) if np.isfinite(bad) else bad
        value = getattr(owner, field)
        if isinstance(value, float):
            setattr(owner, field, bad)
        elif len(value):
            value[self._random.integers(len(value))] = bad

    def _length(self, message: Any) -> None:
        leaves = [leaf for leaf in numbers_of(message) if leaf[2].startswith('sequence')]
        if not leaves:
            return
        owner, field, _ = leaves[self._random.integers(len(leaves))]
        wanted = int(self._random.choice([0, 1, 17, 19, 500]))
        setattr(owner, field, array('d', [0.1] * wanted))

    def _names(self, message: Any) -> None:
        field = {'JointState': 'name', 'JointTrajectory': 'joint_names'}.get(
            type(message).__name__
        )
        if field is None:
            return
        names = list(getattr(message, field))
        ways = ([], [''] * 18, names[:-1], names[1:] * 2, names[::-1], ['lf_hip'] * 18)
        setattr(message, field, ways[self._random.integers(len(ways))])


def numbers_of(message: Any) -> Iterator[tuple[Any, str, str]]:
    """Yield owner, field and type of everything in a message that is made of floats."""
    for field, kind in message.get_fields_and_field_types().items():
        value = getattr(message, field)
        if field == 'header':
            continue
        if 'double' in kind or 'float' in kind:
            yield message, field, kind
        elif isinstance(value, list):
            for item in value:
                if hasattr(item, 'get_fields_and_field_types'):
                    yield from numbers_of(item)
        elif hasattr(value, 'get_fields_and_field_types'):
            yield from numbers_of(value)


class Watch:
    """Everything that leaves a pattern generator, checked as it leaves."""

    def __init__(self, cpg: CpgNode, rated: bool) -> None:
        self.count = 0
        self._rated = rated
        self._last = robot.NEUTRAL_POSE
        publisher = cpg._mode._trajectory
        self._publish = publisher.publish
        publisher.publish = self.check

    def check(self, message: JointTrajectory) -> None:
        targets = np.array([list(point.positions) for point in message.points])
        assert targets.shape == (robot.SUBSTEPS, 18)
        assert np.isfinite(targets).all()
        assert (targets >= robot.JOINT_LOWER).all()
        assert (targets <= robot.JOINT_UPPER).all()
        steps = np.abs(np.diff(targets, axis=0, prepend=self._last[None]))
        assert not self._rated or steps.max() <= MAX_STEP * (1 + 1e-9)
        self._last = targets[-1]
        self.count += 1
        self._publish(message)


class Inputs:
    """Every subscription of some nodes, with a good message of each to spoil."""

    def __init__(self, graph, nodes: list[Node], fuzzer: MessageFuzzer) -> None:
        self._graph = graph
        self._fuzzer = fuzzer
        self.sent: Counter[str] = Counter()
        self.good: dict[str, Any] = {}
        self._publishers = {}
        helper = graph.nodes[0]
        wanted = {s.topic_name: s.msg_type for node in nodes for s in node.subscriptions}
        for topic, kind in wanted.items():
            self._publishers[topic] = helper.create_publisher(kind, topic, 100)
            keep = self.good.__setitem__
            helper.create_subscription(kind, topic, lambda m, t=topic, k=keep: k(t, m), 10)
        graph.until(lambda: set(wanted) <= set(self.good))
        self.good = {topic: copy.deepcopy(message) for topic, message in self.good.items()}
        for subscription in list(helper.subscriptions):
            helper.destroy_subscription(subscription)

    def flood(self, count: int, gates: Mapping[str, SampleGate]) -> None:
        """Send so many malformed messages, one per topic and round, as fast as they are taken.

        Args:
            count: How many.
            gates: What takes them, by topic.
        """
        topics = list(self._publishers)
        for start in range(0, count, len(topics)):
            taken = {topic: gates[topic].counts.received for topic in topics[: count - start]}
            for topic in taken:
                now_ns = self._graph.nodes[0].get_clock().now().nanoseconds
                self._publishers[topic].publish(self._fuzzer.spoil(self.good[topic], now_ns))
                self.sent[topic] += 1
            self._graph.until(
                lambda: all(gates[topic].counts.received > had for topic, had in taken.items())  # noqa: B023
            )


@pytest.fixture
def ros_args(tmp_path, request) -> list[str]:
    """Return arguments for an untrained agent of all channels, in real time if the test says."""
    trainer = Trainer(RunSpec.from_mapping(SMALL, 'small').observing(LETTERS), 5)
    checkpoint.save_agent(tmp_path / 'agent.pt', trainer)
    given = [f'checkpoint:={tmp_path}/agent.pt', 'check_seconds:=0.0']
    given += [f'{p.name}:=0.5' for p in real_time.PARAMETERS if p.name.startswith('max_age')]
    if 'real_time' in request.node.name:
        given += ['sync:=realtime', 'max_age:=0.5']
    return ['--ros-args', *(word for value in given for word in ('-p', value))]


@COUNTS
def test_real_time(graph, monkeypatch, count: int) -> None:
    # As if the publisher that is heard sent them: those of a further one are not even looked at.
    monkeypatch.setattr(SampleGate, '_source_fault', lambda *_: '')
    sim, cpg, play = SimNode(), CpgNode(), PlayNode()
    watch = Watch(cpg, rated=True)
    graph.add(sim, cpg, play)
    driving = lambda: str(play._play.state) == 'driving'  # noqa: E731
    graph.until(driving)
    inputs = Inputs(graph, [sim, cpg, play], MessageFuzzer(SEED))
    assert len(inputs.good) == 17
    gates = {}
    for samples in (sim._real_time._samples, cpg._mode._samples, play._play._samples):
        gates |= {f'/{topic}': gate for topic, gate in samples.gates.items()}
    inputs.flood(count, gates)
    # The good messages go on, so the robot does.
    checked = watch.count
    graph.until(lambda: driving() and watch.count > checked + 80)
    values = {}
    for node in (sim._real_time.health, cpg._health, play._play.health):
        values |= dict(node()[2])
    for topic in (name.removeprefix('/') for name in inputs.good):
        assert values[f'{topic}.received'] >= inputs.sent[f'/{topic}']
        for kind in ('stale', 'future', 'invalid'):
            assert values[f'{topic}.{kind}'] > 0 or topic == 'foot_contacts', (topic, kind)
    kinds: Counter[str] = Counter()
    for name, value in values.items():
        if '.' in name and isinstance(value, int):
            kinds[name.rpartition('.')[2]] += value
    expected = {'duplicate', 'out_of_order', 'not_finite', 'wrong_length', 'wrong_names'}
    expected |= {'wrong_frame', 'wrong_unit'}
    assert expected <= set(+kinds)


@COUNTS
def test_lock_step_pattern_generator(graph, count: int) -> None:
    cpg = graph.add(CpgNode())
    watch = Watch(cpg, rated=False)
    good = CpgCommand()
    command_to_message(command_from_action(np.zeros(30), 'D1', RANGES), good)
    flood_lock_step(graph, cpg, 'cpg/command', good, count)
    played = watch.count
    values = dict(cpg._health()[2])
    not_due = sum(values[kind] for kind in ('late', 'duplicate', 'out_of_order'))
    assert played + not_due + values['rejected'] == count
    assert min(played, values['late'], values['duplicate'], values['out_of_order']) > 0
    assert values['not_finite'] > 0


@COUNTS
def test_lock_step_sim(graph, count: int) -> None:
    sim = graph.add(SimNode())
    good = OutputMessages().trajectory(np.tile(robot.NEUTRAL_POSE, (robot.SUBSTEPS, 1)), 0)
    flood_lock_step(graph, sim, 'joint_trajectory', good, count)
    values = dict(sim._health()[2])
    for kind in ('late', 'duplicate', 'out_of_order', 'not_finite', 'wrong_length', 'wrong_names'):
        assert values[kind] > 0


def flood_lock_step(graph, node: Node, topic: str, good: Any, count: int) -> None:
    """Send so many malformed messages around the period that is due, one after another."""
    fuzzer = MessageFuzzer(SEED)
    publisher = graph.nodes[0].create_publisher(type(good), topic, 100)
    graph.until(lambda: publisher.get_subscription_count() == 1)
    taken: list[int] = []
    callback = next(s for s in node.subscriptions if s.topic_name == f'/{topic}')
    serve = callback.callback
    due = getattr(node, '_mode', node)._due
    callback.callback = lambda message: (serve(message), taken.append(1))
    for number in range(count):
        if due.stamp_ns is None:  # the episode is over, or has not begun
            request = ResetEpisode.Request(seed=number, start=time_message(0))
            assert graph.call(ResetEpisode, f'{node.get_name()}/reset', request).success
        due_ns = due.stamp_ns
        message = fuzzer.spoil(good, due_ns)
        if number % 3 == 0:  # a stamp of lock-step, now and then
            periods = (-1, 0, 1)[number // 3 % 3]
            message.header.stamp = time_message(max(due_ns + periods * robot.CONTROL_PERIOD_NS, 0))
        publisher.publish(message)
        graph.until(lambda: len(taken) > number)  # noqa: B023


@COUNTS
def test_lock_step_agent_ends_the_run_and_takes_another(graph, tmp_path, count: int) -> None:
    cpg, agent = CpgNode(), AgentNode()
    watch = Watch(cpg, rated=False)
    graph.add(SimNode(), cpg, agent)
    goal = TrainRun.Goal(
        run_id='fuzz', checkpoint=f'{tmp_path}/agent.pt', seed=9,
        spec='{task: {time_limit_steps: 10}, training: {episodes: 1, evaluation: 0}}',
    )  # fmt: skip
    helper, fuzzer = graph.nodes[0], MessageFuzzer(SEED)
    good: dict[str, Any] = {}
    publishers: dict[str, Any] = {}

    def keep_good(message: Odometry) -> None:
        for subscription in agent.subscriptions:
            topic, kind = subscription.topic_name, subscription.msg_type
            if topic not in publishers:
                publishers[topic] = helper.create_publisher(kind, topic, 1000)
                helper.create_subscription(kind, topic, partial(good.__setitem__, topic), 10)

    def flood(message: Odometry) -> None:
        due_ns = to_nanoseconds(message.header.stamp) + robot.CONTROL_PERIOD_NS
        for topic in [*good] * 6:
            publishers[topic].publish(fuzzer.spoil(good[topic], due_ns))

    helper.create_subscription(Odometry, 'odom', keep_good, 10)
    clean = graph.train(goal).result
    assert (clean.message, len(publishers)) == ('', 16)
    graph.until(lambda: len(good) == 16)
    flooding = helper.create_subscription(Odometry, 'odom', flood, 10)
    complaints = []
    while fuzzer.made.total() < 2 * count:  # each message counts by contents and by stamp
        complaints.append(graph.train(goal).result.message)
    assert any(complaints)
    helper.destroy_subscription(flooding)
    result = graph.train(goal).result
    assert (result.message, result.final_average_reward) == ('', clean.final_average_reward)
    assert watch.count > 10
