# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The buffer returns the transitions that were stored, across episode ends and its own wrap."""

import numpy as np
import pytest
import torch
from hexapod_agent.algorithms.replay import Batch, ReplayBuffer

DISCOUNT = 0.5


def make(capacity: int = 100, n_step: int = 1) -> ReplayBuffer:
    return ReplayBuffer(capacity, 1, 1, DISCOUNT, n_step)


def fill(buffer: ReplayBuffer, first: int, steps: int, terminated: bool = False) -> None:
    """Store an episode with observations first, first + 1, ..., each the action and reward too."""

    def vector(number: int) -> np.ndarray:
        return np.array([number], np.float32)

    buffer.begin(vector(first))
    for number in range(first, first + steps):
        last = number == first + steps - 1
        buffer.add(vector(number), number, vector(number + 1), terminated and last)


def drawn(buffer: ReplayBuffer, count: int = 500) -> dict[int, tuple[float, ...]]:
    """Sample often and map each observation to (action, reward, next, bootstrap)."""
    batch = Batch.empty(1, count, 1, 1, torch.float32)
    buffer.sample(np.random.default_rng(0), batch)
    parts = (batch.observation, batch.action, batch.reward, batch.next_observation)
    rows = torch.cat([*parts, batch.bootstrap], dim=-1)[0].tolist()
    return {int(row[0]): tuple(row[1:]) for row in rows}


def test_transitions_do_not_cross_episodes():
    buffer = make()
    fill(buffer, 10, 3)
    fill(buffer, 20, 2, terminated=True)
    assert len(buffer) == 5
    assert drawn(buffer) == {
        10: (10, 10, 11, DISCOUNT),
        11: (11, 11, 12, DISCOUNT),
        12: (12, 12, 13, DISCOUNT),  # time limit: the value of what follows still counts
        20: (20, 20, 21, DISCOUNT),
        21: (21, 21, 22, 0.0),  # fall: it does not
    }


def test_n_step_returns_by_hand():
    buffer = make(n_step=3)
    fill(buffer, 1, 4)
    fill(buffer, 20, 2, terminated=True)
    assert drawn(buffer) == {
        1: (1, 1 + 2 / 2 + 3 / 4, 4, 1 / 8),
        2: (2, 2 + 3 / 2 + 4 / 4, 5, 1 / 8),
        3: (3, 3 + 4 / 2, 5, 1 / 4),  # the episode ends after two steps
        4: (4, 4, 5, 1 / 2),
        20: (20, 20 + 21 / 2, 22, 0.0),  # the fall within the n steps
        21: (21, 21, 22, 0.0),
    }


@pytest.mark.parametrize('n_step', [1, 3])
@pytest.mark.parametrize('capacity', [7, 8, 9, 10])
def test_a_full_ring_keeps_the_newest_transitions(capacity, n_step):
    """Compare with a list of all transitions, of which the last that fit in the rows remain."""
    buffer = make(capacity, n_step)
    expected, rows = {}, []
    for episode in range(6):
        first = 10 * episode
        fill(buffer, first, 4, terminated=episode % 2 == 1)
        rows += range(first, first + 5)
        for number in range(first, first + 4):
            count = min(n_step, first + 4 - number)
            terminal = episode % 2 == 1 and number + count == first + 4
            value = sum((number + k) * DISCOUNT**k for k in range(count))
            expected[number] = (
                number, value, number + count, 0.0 if terminal else DISCOUNT**count,
            )  # fmt: skip
        kept = {number: expected[number] for number in rows[-capacity:] if number in expected}
        assert len(buffer) == len(kept)
        assert drawn(buffer) == kept


def test_draws_are_uniform():
    buffer = make()
    fill(buffer, 0, 4)
    batch = Batch.empty(1, 20_000, 1, 1, torch.float32)
    buffer.sample(np.random.default_rng(0), batch)
    shares = np.bincount(batch.observation.flatten().int().numpy()) / 20_000
    # Standard error of a share of 1/4 is 0.003.
    assert shares == pytest.approx([0.25] * 4, abs=0.012)


@pytest.mark.parametrize('episodes', [1, 4])
def test_restored_buffer_goes_on_alike(episodes):
    buffer, twin = make(12), make(12)
    for episode in range(episodes):
        fill(buffer, 10 * episode, 4)
    twin.restore(buffer.state())
    for each in (buffer, twin):
        fill(each, 90, 2)
    assert drawn(twin) == drawn(buffer)


def test_batches_drawn_at_once_are_those_drawn_one_after_another():
    buffer = make()
    fill(buffer, 1, 50)
    group, single = (Batch.empty(n, 7, 1, 1, torch.float32) for n in (3, 1))
    buffer.sample(np.random.default_rng(0), group)
    generator = np.random.default_rng(0)
    for number in range(3):
        buffer.sample(generator, single)
        alone = vars(single.inner(0)).values()
        for ours, theirs in zip(vars(group.inner(number)).values(), alone, strict=True):
            assert torch.equal(ours, theirs)


def test_part_of_a_stack_is_filled_as_a_batch_of_one():
    buffer = make()
    fill(buffer, 1, 50)
    stack, single = (Batch.empty(n, 20, width, 1, torch.float32) for n, width in ((3, 4), (1, 1)))
    buffer.sample(np.random.default_rng(0), stack.part(slice(1, 2), 1))
    buffer.sample(np.random.default_rng(0), single)
    for whole, part in zip(vars(stack).values(), vars(single).values(), strict=True):
        assert torch.equal(whole[1:2, :, :1], part)
        assert not whole[0].any()
        assert not whole[..., 1:].any()
