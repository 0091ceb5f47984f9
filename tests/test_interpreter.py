# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Results do not depend on the version of the interpreter, whose `sum` of floats does."""

import builtins
from collections.abc import Iterable
from pathlib import Path

import pytest
from hexapod_agent.algorithms.policies import random_policy
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.environment.evaluation import run_episode, summarize
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.train import train_episode
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.choosing.devices import read_devices
from hexapod_doe.replays.rescoring import recorded_config, rescore

SAMPLE = Path(__file__).parents[1] / 'bags' / 'sample'
SMALL = RunSpec.from_mapping(
    {
        'task': {'time_limit_steps': 40},
        'actor': {'hidden': [16]},
        'critic': {'hidden': [16]},
        'ddpg': {'batch_size': 16, 'buffer_size': 100, 'update_every': 8},
    },
    'small',
)
plain_sum = builtins.sum


def compensated_sum(values: Iterable, start=0):
    """Add as CPython does since 3.12: Neumaier's sum while what comes are floats and integers."""
    values = list(values)
    if start or not any(type(value) is float for value in values):
        return plain_sum(values, start)
    total = lost = 0.0
    for value in values:
        new = total + value
        larger, smaller = (total, value) if abs(total) >= abs(value) else (value, total)
        lost += (larger - new) + smaller
        total = new
    return total + lost


def training() -> list[object]:
    """Summaries of a training, with each reward term."""
    trainer, env = Trainer(SMALL.observing('ABCDE'), 1), HexapodLine('ABCDE', SMALL)
    return [train_episode(env, trainer) for _ in range(2)]


def rewards() -> object:
    env, policy = HexapodLine('ABCDE'), random_policy(1)
    observation, _ = env.reset(seed=1)
    return [env.step(policy(observation))[1] for _ in range(200)]


def evaluation() -> object:
    env, policy = HexapodLine('', SMALL), random_policy(1)
    return summarize([run_episode(env, policy, 1, start) for start in range(3)])


def rescored() -> object:
    bag = BagFile(SAMPLE)
    (row,) = rescore(bag, recorded_config(bag).task)
    return row.episode_return, row.recorded_return, row.terms, row.equal


def costs() -> object:
    table = read_devices()
    return [table.cheapest(letters) for letters in ('ABCDEFG', 'AB', 'CDE')]


def test_the_emulated_sum_is_not_the_plain_one() -> None:
    values = [0.1] * 10
    # math.fsum([0.1] * 10) == 1.0; nine roundings from left to right lose 2^-53.
    assert compensated_sum(values) == 1.0
    assert compensated_sum([1, 2]) == 3


@pytest.mark.parametrize('result', [rewards, training, evaluation, rescored, costs])
def test_results_are_the_same_to_the_last_bit(result, monkeypatch) -> None:
    expected = repr(result())
    monkeypatch.setattr(builtins, 'sum', compensated_sum)
    assert repr(result()) == expected
