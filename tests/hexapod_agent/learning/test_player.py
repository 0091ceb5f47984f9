# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A player acts as its policy says, counts as a trainer does and learns nothing."""

import math

import numpy as np
import pytest
from hexapod_agent.learning.player import Player
from hexapod_sim.task import Outcome

ACTION = np.full(30, 0.96, np.float32)
SEEN = np.zeros(3, np.float32)


def outcome(step: int, reward: float, truncated: bool = False) -> Outcome:
    return Outcome(step, reward, {'alive': reward}, False, truncated, '')


def play(player: Player, episode: int, rewards: list[float]) -> None:
    player.begin_episode(episode)
    np.testing.assert_array_equal(player.observe(SEEN, outcome(0, 0.0)), ACTION)
    for step, reward in enumerate(rewards[:-1], start=1):
        player.observe(SEEN, outcome(step, reward))
        player.learn()
    player.end_episode(SEEN, outcome(len(rewards), rewards[-1], truncated=True))


def test_summary_counts_what_was_earned():
    player = Player(lambda observation: ACTION, window=2)
    with pytest.raises(RuntimeError, match='no episode is complete'):
        _ = player.summary
    play(player, 0, [100.0])
    play(player, 1, [1.0, 2.0, 3.0])
    assert player.summary.episode_return == 6.0
    assert player.summary.average_return == 53.0
    play(player, 2, [2.0])
    summary = player.summary
    assert summary.average_return == 4.0  # the last two of three
    assert (summary.episode, summary.steps, summary.terms) == (2, 1, {'alive': 2.0})
    assert summary.metrics['saturated_share'] == 1.0
    assert summary.metrics['updates'] == 0
    assert math.isnan(summary.metrics['critic_loss'])
