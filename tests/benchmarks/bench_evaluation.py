# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Share that the evaluation adds to a training of 100 episodes; the target is below 5 %.

Run: `python tests/benchmarks/bench_evaluation.py`. Each way trains some episodes of article.yaml
and then evaluates: both are timed within one run, so that other load on the machine tells on both.
"""

import os
import shlex
import signal
import subprocess
import time
from contextlib import suppress
from itertools import islice

import rclpy
from bench_graph import Client
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.train import evaluate, train_episode
from hexapod_interfaces.action import TrainRun
from rclpy.action import ActionClient

OBSERVATIONS = 'ABCDE'
WARM_UP, TRAINED, EVALUATED = 2, 4, 20
OF_EPISODES = 100
TARGET = 0.05


def share(training_s: float, evaluation_s: float) -> float:
    """Return the share of seconds per episode of an evaluation in a training of the same."""
    evaluation = RunSpec.load().training.evaluation
    return evaluation * evaluation_s / (OF_EPISODES * training_s)


def environment() -> float:
    """A run in the Gymnasium environment."""
    trainer = Trainer(RunSpec.load().observing(OBSERVATIONS), 1)
    env = HexapodLine(config=trainer.config)
    for _ in range(WARM_UP):
        train_episode(env, trainer)
    began = time.perf_counter()
    for _ in range(TRAINED):
        train_episode(env, trainer)
    trained = time.perf_counter()
    evaluated = len(list(islice(evaluate(env, trainer), EVALUATED)))
    return share((trained - began) / TRAINED, (time.perf_counter() - trained) / evaluated)


def worker(client: Client, namespace: str, composed: str) -> float:
    """A run of a worker on the graph, in one process or in four."""
    line = f'ros2 launch hexapod_bringup worker.launch.xml namespace:={namespace}'
    launched = subprocess.Popen(
        [*shlex.split(line), f'composed:={composed}'], stdout=subprocess.DEVNULL
    )
    ended: list[float] = []

    def note(message: TrainRun.Impl.FeedbackMessage) -> None:
        if message.feedback.ended:
            ended.append(time.perf_counter())

    try:
        action = ActionClient(client.node, TrainRun, f'/{namespace}/train_run')
        client.warm_up(action, goal(1, 0))
        handle = client.result(
            action.send_goal_async(goal(WARM_UP + TRAINED, EVALUATED), feedback_callback=note)
        )
        response = client.result(handle.get_result_async())
        assert response.result.message == '', response.result.message
        evaluation_s = (time.perf_counter() - ended[-1]) / EVALUATED
    finally:
        launched.send_signal(signal.SIGINT)
        with suppress(subprocess.TimeoutExpired):
            launched.wait(15.0)
    return share((ended[-1] - ended[WARM_UP - 1]) / TRAINED, evaluation_s)


def goal(episodes: int, evaluation: int) -> TrainRun.Goal:
    """Return a run of article.yaml of other lengths."""
    training = f'{{episodes: {episodes}, evaluation: {evaluation}}}'
    spec = f'{{observations: {OBSERVATIONS}, training: {training}}}'
    return TrainRun.Goal(run_id='bench', spec=spec, seed=1)


def main() -> None:
    """Print the share by way."""
    os.environ.setdefault('OMP_NUM_THREADS', '1')
    client = Client()
    shares = {
        'environment': environment(),
        'composed worker': worker(client, 'composed', 'true'),
        'four processes': worker(client, 'separate', 'false'),
    }
    for name, found in shares.items():
        print(f'{name:16} {found:6.1%} (target below {TARGET:.0%})')
    rclpy.shutdown()


if __name__ == '__main__':
    main()
