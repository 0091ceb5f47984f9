# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Bags of episodes that the task played, with the outcomes that it gave."""

from __future__ import annotations

from array import array
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import yaml
from hexapod_cpg.cpg import Cpg
from hexapod_cpg.mapping import ActionRanges, command_from_action
from hexapod_cpg.oscillator import HopfConfig
from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.bags.rosbag2 import Topic
from hexapod_sim.scenes.table import SceneConfig
from hexapod_sim.task import LineTask, Outcome
from hexapod_sim.task_config import TaskConfig
from hexapod_sim.variations.table import RobotConfig
from hexapod_sim.world import World

RANGES = ActionRanges.of_article()

PERIOD_NS = 25_000_000
TOPICS = {
    'odom': 'nav_msgs/msg/Odometry',
    'line_offset': 'hexapod_interfaces/msg/LineOffset',
    'step_outcome': 'hexapod_interfaces/msg/StepOutcome',
}


def play(
    config: TaskConfig,
    seed: int,
    look: Callable[[LineTask, Outcome], None],
    world: World | None = None,
) -> list[Outcome]:
    """Walk straight until the episode ends; show each sample, and return the outcomes."""
    task, cpg = LineTask(config, world=world), Cpg(HopfConfig.of_article())
    outcome = task.reset(seed)
    look(task, outcome)
    outcomes = []
    while not (outcome.terminated or outcome.truncated):
        outcome = task.advance(cpg.advance(command_from_action(np.zeros(30), 'D1', RANGES)))
        look(task, outcome)
        outcomes.append(outcome)
    return outcomes


def messages(task: LineTask, outcome: Outcome) -> dict[str, object]:
    """Return what the sim publishes of a sample."""
    from hexapod_interfaces.msg import LineOffset, StepOutcome
    from hexapod_sim.nodes.messages import fill_odometry, new_odometry

    odometry = new_odometry()
    fill_odometry(odometry, task.simulation)
    told = StepOutcome(
        step=outcome.step,
        reward=outcome.reward,
        term_names=list(outcome.terms),
        term_values=array('d', outcome.terms.values()),
        terminated=outcome.terminated,
        truncated=outcome.truncated,
        cause=outcome.cause,
    )
    return {
        'odom': odometry,
        'line_offset': LineOffset(offset=task.line_offset),
        'step_outcome': told,
    }


@pytest.fixture
def record(tmp_path: Path) -> Callable[..., tuple[Path, list[list[Outcome]]]]:
    """Return a function that records episodes and returns the bag and their outcomes."""

    def record_bag(
        config, seeds=(1,), leave_out=(), lose=None, change=None, sensors=(), scene=None
    ):
        from rclpy.serialization import serialize_message

        spec = {'task': vars(config), 'sensors': dict(sensors), 'scene': dict(scene or {})}
        world = World(SceneConfig.of_article(**spec['scene']), RobotConfig.of_article())
        told = {'run_id': 'walk', 'config': yaml.safe_dump(spec)}
        stamp = 0
        with BagWriter(tmp_path / 'walk', told) as writer:

            def write(task: LineTask, outcome: Outcome) -> None:
                nonlocal stamp
                stamp += PERIOD_NS
                for name, message in messages(task, outcome).items():
                    if name in leave_out or (name, outcome.step) == lose:
                        continue
                    if change is not None:
                        change(name, outcome.step, message)
                    seconds, nanoseconds = divmod(stamp, 1_000_000_000)
                    message.header.stamp.sec, message.header.stamp.nanosec = seconds, nanoseconds
                    topic = Topic(f'/w/{name}', TOPICS[name])
                    writer.add_topic(topic)
                    writer.write(topic.name, serialize_message(message), stamp)

            outcomes = [play(config, seed, write, world) for seed in seeds]
        return tmp_path / 'walk', outcomes

    return record_bag
