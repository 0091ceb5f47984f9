# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node agent: what it subscribes to, what it learns, and errors that end a run by name."""

from __future__ import annotations

import math
from dataclasses import asdict, replace
from importlib.resources import files

import numpy as np
import pytest
import torch
import yaml
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning.training import Trainer
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.train import evaluate, train_episode
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_interfaces.action import TrainRun
from hexapod_interfaces.msg import EpisodeResult
from hexapod_node.matching import subscribed_topics
from hexapod_sim.nodes.sim_node import SimNode
from hexapod_sim.sensor_table import LETTERS
from rclpy.action import ActionClient
from sensor_msgs.msg import Imu, JointState

pytestmark = pytest.mark.graph
ALWAYS = {'/joint_states', '/cpg/state', '/line_offset', '/step_outcome'}


@pytest.fixture
def short(tmp_path) -> str:
    """Return a configuration of short episodes and small batches."""
    path = tmp_path / 'short.yaml'
    path.write_text(
        'task: {time_limit_steps: 60}\nddpg: {batch_size: 32, update_every: 6}\n'
        'training: {evaluation: 2}\n'
    )
    return str(path)


@pytest.fixture
def swift(tmp_path) -> str:
    """Return swift.yaml with short episodes and small batches; its actor waits for one episode."""
    changes = yaml.safe_load((files('hexapod_agent') / 'swift.yaml').read_text())
    changes['task'] = {'time_limit_steps': 60}
    changes['learner']['ddpg'] |= {'batch_size': 32, 'update_every': 8}
    changes['learner']['actor']['waits'] = 3
    changes['training'] |= {'episodes': 3, 'evaluation': 2}
    path = tmp_path / 'swift.yaml'
    path.write_text(yaml.safe_dump(changes))
    return str(path)


@pytest.mark.parametrize(
    ('letters', 'topics'),
    [
        ('', set()),
        ('CE', {'/imu/data', '/body/height'}),
        ('F', {f'/foot_force/{leg}' for leg in ('lf', 'lm', 'lr', 'rf', 'rm', 'rr')}),
        (LETTERS, None),
    ],
)
def test_the_topic_graph_is_the_treatment(graph, spec, short: str, letters: str, topics) -> None:
    node = graph.nodes[0]
    seen: list[set[str]] = []

    class Watching(Trainer):
        def end_episode(self, observation, outcome):
            seen.append(set(subscribed_topics(node, 'agent', '/')))
            return super().end_episode(observation, outcome)

    heard: list[EpisodeResult] = []
    node.create_subscription(EpisodeResult, 'episode_result', heard.append, 10)
    graph.add(SimNode(), CpgNode(), AgentNode(Watching))
    expected = ALWAYS | {f'/{topic}' for topic in ObservationSpec(letters).topics}
    goal = TrainRun.Goal(run_id='r', spec=spec(letters, 2, short), seed=1)
    response = graph.train(goal)
    assert response.result.message == ''
    graph.until(lambda: len(heard) == 2)
    assert seen[0] == expected
    if topics is not None:
        assert expected == ALWAYS | topics
    graph.until(lambda: subscribed_topics(node, 'agent', '/') == [])
    for result in heard:
        assert (result.late, result.missing, result.duplicate, result.out_of_order) == (0, 0, 0, 0)


@pytest.mark.parametrize('name', ['short', 'swift'])
def test_a_seed_gives_the_same_weights_on_the_graph_and_in_the_environment(
    graph, request, spec, name: str
) -> None:
    path = request.getfixturevalue(name)
    trainers: list[Trainer] = []

    def make_trainer(*args) -> Trainer:
        trainers.append(Trainer(*args))
        return trainers[0]

    graph.add(SimNode(), CpgNode(), AgentNode(make_trainer))
    goal = TrainRun.Goal(run_id='r', spec=spec('ABCDE', 3, path), seed=7)
    response = graph.train(goal)
    config = RunSpec.load(path)
    alone = Trainer(config.observing('ABCDE'), 7)
    env = HexapodLine('ABCDE', config)
    for _ in range(3):
        train_episode(env, alone)
    np.testing.assert_equal(asdict(alone.summary), asdict(trainers[0].summary))  # NaN too
    assert alone.summary.metrics['updates'] > 0
    assert response.result.final_average_reward == alone.average_return
    *_, judged = evaluate(env, alone)
    assert response.result.evaluation_return == judged.average_return
    on_graph, in_env = (t.state_dict() for t in (trainers[0], alone))
    assert_same(on_graph, in_env)


def test_a_worker_that_evaluates_gives_signs_of_life(graph, spec, short: str, monkeypatch) -> None:
    monkeypatch.setattr('hexapod_agent.nodes.graph_run._LIFE_S', 0.01)
    agent = AgentNode()
    graph.add(SimNode(), CpgNode(), agent)
    client = ActionClient(graph.nodes[0], TrainRun, 'train_run')
    graph.until(client.server_is_ready)
    heard: list[tuple[str, bool]] = []

    def note(message) -> None:
        if agent._run is not None:
            heard.append((agent._run.phase, message.feedback.ended))

    goal = TrainRun.Goal(run_id='r', spec=spec('', 1, short), seed=1)
    handle = graph.result(client.send_goal_async(goal, note))
    graph.result(handle.get_result_async())
    client.destroy()
    assert ('evaluating', False) in heard  # and no episode of it is taken for one of the training
    assert sum(ended for _, ended in heard) == 1


def assert_same(left, right) -> None:
    """Compare nested states to the last bit."""
    assert type(left) is type(right)
    if isinstance(left, dict):
        assert left.keys() == right.keys()
        for key in left:
            assert_same(left[key], right[key])
    elif isinstance(left, torch.Tensor):
        assert torch.equal(left, right)
    elif isinstance(left, list | tuple):
        for one, other in zip(left, right, strict=True):
            assert_same(one, other)
    else:
        assert left == right or left != left


@pytest.mark.parametrize(
    ('change', 'complaint'),
    [
        ({'spec': 'observations: ABX'}, "unknown letter 'X', expected letters of ABCDEFG"),
        ({'spec': 'task: [1]'}, 'spec: task is [1], expected keys'),
        ({'spec': 'task: {colour: 1}'}, "spec: unknown key 'task.colour', expected one of "),
        ({'spec': 'training: {episodes: 0}'}, 'spec: training.episodes is 0, expected: '),
        ({'spec': '7'}, 'spec: expected sections with keys'),
        ({'spec': '{task: {'}, 'spec: not YAML: '),
        ({'spec': '{task: 2026-77-77}'}, 'spec: not YAML: month must be in 1..12'),
        ({'spec': 'a: &a [1]\nb: *a'}, 'spec: an alias'),
        ({'spec': 30_000 * '#'}, 'spec: 30000 characters, expected at most 20000'),
        ({'spec': 9_000 * '['}, 'spec: 9000 brackets, expected at most 500'),
        ({'spec': 'a:\n ' + 9_000 * '- '}, 'spec: not YAML: maximum recursion depth'),
        ({'spec': f'task: {{line_y: {5000 * "x"}}}'}, "xx', expected: "),
        (
            {'spec': 'learner: {ddpg: {update_every: 700}}'},
            'update_every is 700, expected at most task.time_limit_steps, 600',
        ),
        ({'checkpoint': 'TMP/wrong.pt'}, "wrong.pt': cannot be used, this worker prints why"),
        ({'bag': '/no/such/bag'}, "bag '/no/such/bag': not below"),
        ({'bag': 'TMP/../bag'}, "bag': not below"),
        ({'bag': 'TMP'}, 'not below'),
        ({'bag': 'TMP/link/bag'}, "bag': not below"),
        ({'bag': 'TMP/' + 300 * 'a'}, 'File name too long'),
    ],
)
def test_a_wrong_goal_ends_with_one_clear_error(
    graph, tmp_path, capfd, change, complaint: str
) -> None:
    (tmp_path / 'wrong.pt').write_text('no checkpoint')
    (tmp_path / 'link').symlink_to(tmp_path.parent)
    graph.add(AgentNode())
    goal = TrainRun.Goal(run_id='r', spec='observations: A', seed=1)
    for name, value in change.items():
        setattr(
            goal, name, value.replace('TMP', str(tmp_path)) if isinstance(value, str) else value
        )
    response = graph.train(goal)
    assert complaint in response.result.message
    # What tells of a file goes to the worker's own output, not to the log that every peer hears.
    told = [line for line in capfd.readouterr().err.splitlines() if 'cannot be read' in line]
    assert len(told) == ('wrong' in complaint)
    assert not any('[agent]' in line for line in told)
    assert 'cannot be read' not in response.result.message


class Faulty(SimNode):
    """A sim whose sensor topics can be spoiled."""

    def __init__(self, topic: str, spoil) -> None:
        super().__init__()
        for publisher in self._topics.all:
            if publisher.topic_name == f'/{topic}':
                publisher.route = compose(publisher.route, spoil)


def compose(route, spoil):
    """Return the route of a publisher whose messages are spoiled on their way."""

    def spoiled():
        publish = route()
        return publish and (lambda message: publish(spoil(message)))

    return spoiled


def nan(message: Imu) -> Imu:
    message.angular_velocity.y = math.nan
    return message


def short_array(message: JointState) -> JointState:
    return JointState(header=message.header, name=message.name, effort=[0.0] * 17)


def unnamed(message: JointState) -> JointState:
    return JointState(
        header=message.header,
        name=['a', *message.name[1:]],
        position=message.position,
        velocity=message.velocity,
    )


@pytest.mark.parametrize(
    ('topic', 'spoil', 'complaint'),
    [
        ('imu/data_raw', nan, r'angular_velocity[1] is nan, expected a finite number'),
        ('joint_torques', short_array, 'joint_torques: effort has 17 numbers for 18 names'),
        ('joint_states', unnamed, 'joint_states: name lacks lf_hip'),
    ],
)
def test_a_wrong_message_ends_the_run_by_name(graph, spec, short, topic, spoil, complaint) -> None:
    graph.add(Faulty(topic, spoil), CpgNode(), AgentNode())
    goal = TrainRun.Goal(run_id='r', spec=spec(LETTERS, 1, short), seed=1)
    response = graph.train(goal)
    assert complaint in response.result.message


def test_a_silent_topic_ends_the_run_by_name(graph, spec, short: str) -> None:
    agent = AgentNode()
    agent._run_context = replace(agent._run_context, timeout_s=1.0)
    sim = SimNode()
    graph.add(sim, CpgNode(), agent)
    for publisher in sim._topics.all:
        if publisher.topic_name == '/body/height':
            publisher.route = lambda: None
    goal = TrainRun.Goal(run_id='r', spec=spec('CE', 1, short), seed=1)
    response = graph.train(goal)
    assert 'no sample of body/height stamped' in response.result.message


def test_a_joint_driver_may_have_its_own_order_and_more_joints(graph, spec, short: str) -> None:
    def reorder(message: JointState) -> JointState:
        order = [*reversed(range(18))]
        return JointState(
            header=message.header,
            name=[*(message.name[i] for i in order), 'pan'],
            position=[*(message.position[i] for i in order), 9.0],
            velocity=[*(message.velocity[i] for i in order), 9.0],
        )

    graph.add(Faulty('joint_states', reorder), CpgNode(), AgentNode())
    goal = TrainRun.Goal(run_id='r', spec=spec('', 1, short), seed=1)
    response = graph.train(goal)
    config = RunSpec.load(short)
    in_order = Trainer(config.observing(''), 1)
    train_episode(HexapodLine('', config), in_order)
    assert response.result.final_average_reward == in_order.average_return


def test_an_agent_takes_one_run_at_a_time(graph) -> None:
    agent = AgentNode()
    graph.add(agent)
    agent._reserved = True
    with pytest.raises(AssertionError):
        graph.train(TrainRun.Goal(run_id='r'))
