# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A campaign from plan to bags, through a manager and workers of its own."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_doe.bags.run_record import read_run
from hexapod_doe.designs.plan_file import read_plan
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

from .conftest import Shell

pytestmark = pytest.mark.system
ALWAYS = {'joint_states', 'cpg/state', 'line_offset', 'step_outcome'}
STEPS = 40
ACTION = 'hexapod_interfaces/action/TrainRun'
WAITING_CLIENT = """
import rclpy
from hexapod_interfaces.action import TrainRun
from rclpy.action import ActionClient

rclpy.init()
client = ActionClient(rclpy.create_node('waiting'), TrainRun, '/ghost/train_run')
client.wait_for_server()
"""
MANAGER = (
    'ros2 run hexapod_doe manager_node --ros-args -p plan:=plan.csv -p episodes:=2 '
    '-p record_every:=2 -p config:={config} -p local_workers:={workers}'
)


def write_plan(shell: Shell) -> Path:
    """Write a plan of four short runs and the configuration that makes them short."""
    line = 'ros2 run hexapod_doe plan --generators C=AB --factors 3 --seed 3 --out plan.csv'
    assert shell.call(line).returncode == 0
    (shell.directory / 'short.yaml').write_text(
        f'task: {{time_limit_steps: {STEPS}}}\nddpg: {{batch_size: 16, update_every: 8}}\n'
        'training: {evaluation: 2}\n'
    )
    return shell.directory / 'plan.csv'


def manager(shell: Shell, workers: int) -> str:
    return MANAGER.format(config=shell.directory / 'short.yaml', workers=workers)


@pytest.fixture(scope='module')
def finished(tmp_path_factory: pytest.TempPathFactory, own_domain: int) -> Path:
    """Run the campaign on two workers, and return its plan; nothing is to change there."""
    shell = Shell(tmp_path_factory.mktemp('finished'))
    plan = write_plan(shell)
    ended = shell.run(manager(shell, 2), timeout_s=120.0)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert '4 of 4 runs' in ended.stdout
    return plan


def bags_of(plan: Path) -> list[Path]:
    return [plan.parent / 'runs' / run_id for run_id in read_plan(plan).rows['run_id']]


def test_each_bag_is_whole_and_readable_by_others(finished: Path) -> None:
    rows = read_plan(finished).rows.set_index('run_id')
    for bag in bags_of(finished):
        record = read_run(bag)
        row = rows.loc[bag.name]
        assert record.metadata['observations'] == row['observations']
        assert record.metadata['seed'] == str(row['seed'])
        assert list(record.episodes.index) == [0, 1]
        assert list(record.episodes['steps']) == [STEPS, STEPS]
        assert not record.episodes[['late', 'missing', 'duplicate', 'out_of_order']].any().any()
        assert_subscriptions(record.metadata, row['observations'])
        assert_read_by_rosbags(bag)
        assert_read_by_mcap(bag)


def assert_subscriptions(metadata: dict[str, str], observations: str) -> None:
    """The graph reported the topics of the set, and no other sensor."""
    expected = ALWAYS | set(ObservationSpec(observations).topics)
    found = metadata['subscriptions'].split('\n')
    assert {topic.split('/', 2)[2] for topic in found} == expected
    assert len(found) == len(expected)


def assert_read_by_rosbags(bag: Path) -> None:
    with AnyReader([bag]) as reader:
        counts = {c.topic: 0 for c in reader.connections}
        for connection, _, data in reader.messages():
            reader.deserialize(data, connection.msgtype)
            counts[connection.topic] += 1
        assert counts == {topic: info.msgcount for topic, info in reader.topics.items()}
        sampled = {topic.split('/', 2)[2]: count for topic, count in counts.items()}
    assert [sampled.pop(f'{name}_result') for name in ('episode', 'evaluation')] == [2, 2]
    # A sampled episode has a sensor sample at both its ends, and a command per period between.
    assert {sampled.pop(topic) for topic in ('cpg/command', 'joint_trajectory')} == {STEPS}
    assert set(sampled.values()) == {STEPS + 1}
    assert 'foot_force/rr' in sampled


def assert_read_by_mcap(bag: Path) -> None:
    (file,) = bag.glob('*.mcap')
    with file.open('rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        kinds = {schema.name for schema, *_ in reader.iter_decoded_messages()}
    assert 'hexapod_interfaces/msg/CpgCommand' in kinds
    assert 'geometry_msgs/msg/WrenchStamped' in kinds


def test_what_is_done_is_not_done_again(shell, finished: Path) -> None:
    shutil.copytree(finished.parent, shell.directory, dirs_exist_ok=True)
    plan = shell.directory / finished.name
    bags = bags_of(plan)
    before = {bag: (bag / 'metadata.yaml').stat().st_mtime_ns for bag in bags}
    (bags[2] / 'metadata.yaml').unlink()
    assert shell.call(f'ros2 run hexapod_doe campaign_status {plan.parent}').returncode == 1
    ended = shell.run(manager(shell, 1), timeout_s=120.0)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    after = {bag: (bag / 'metadata.yaml').stat().st_mtime_ns for bag in bags}
    changed = [bag for bag in bags if before[bag] != after[bag]]
    assert changed == [bags[2]]
    assert shell.call(f'ros2 run hexapod_doe campaign_status {plan.parent}').returncode == 0


def test_a_worker_that_never_appears_is_one_clear_error(shell) -> None:
    write_plan(shell)
    # Somebody else who waits for a worker is not one, nor is a worker that is there to play.
    waiting = shell.directory / 'waiting.py'
    waiting.write_text(WAITING_CLIENT)
    shell.start(f'{sys.executable} {waiting}')
    player = 'ros2 launch hexapod_bringup worker.launch.xml namespace:=follow composed:=true'
    shell.start(f'{player} for_hire:=false')
    ended = shell.run(f'{manager(shell, 0)} -p worker_timeout:=7.0')
    assert ended.returncode == 1
    assert f'no worker offers the action {ACTION}' in ended.stdout
    assert 'ros2 launch hexapod_bringup worker.launch.xml' in ended.stdout
