# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The pattern generator: state, sub-steps, batches and errors."""

import dataclasses

import numpy as np
import pytest
from hexapod_cpg.cpg import Cpg
from hexapod_cpg.mapping import (
    ACTION_SIZE,
    COMMAND_FIELDS,
    ActionRanges,
    command_from_action,
    joint_targets,
)
from hexapod_cpg.oscillator import HopfConfig, start_state, trajectory

from hexapod_sim import robot

RANGES = ActionRanges.of_article()


def actions(seed: int, *shape: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-1, 1, (*shape, ACTION_SIZE))


def test_starts_and_restarts_on_the_limit_cycle() -> None:
    cpg = Cpg(HopfConfig.of_article())
    expected = start_state(HopfConfig.of_article())
    np.testing.assert_array_equal((cpg.x, cpg.y), expected)
    cpg.advance(command_from_action(actions(0), 'D1', RANGES))
    assert not np.array_equal(cpg.x, expected[0])
    cpg.reset()
    np.testing.assert_array_equal((cpg.x, cpg.y), expected)


def test_advance_maps_every_sub_step() -> None:
    cpg = Cpg(HopfConfig.of_article())
    command = command_from_action(actions(1), 'D1', RANGES)
    xs, ys = trajectory(cpg.x, cpg.y, command.mu, command.frequency, cpg.config)
    targets = cpg.advance(command)
    assert targets.shape == (robot.SUBSTEPS, 18)
    assert targets.dtype == np.float64
    for substep in range(robot.SUBSTEPS):
        np.testing.assert_array_equal(
            targets[substep], joint_targets(command, xs[substep], ys[substep])
        )
    np.testing.assert_array_equal((cpg.x, cpg.y), (xs[-1], ys[-1]))


def test_reset_repeats_the_same_bits() -> None:
    cpg = Cpg(HopfConfig.of_article())
    commands = [command_from_action(action, 'D1', RANGES) for action in actions(2, 30)]
    first = [cpg.advance(command) for command in commands]
    cpg.reset()
    np.testing.assert_array_equal([cpg.advance(command) for command in commands], first)


@pytest.mark.parametrize('batch', [(1,), (4,), (2, 3)])
@pytest.mark.parametrize('reading', ['D1', 'D2'])
def test_a_fleet_repeats_single_robots_to_the_last_bit(
    batch: tuple[int, ...], reading: str
) -> None:
    fleet = Cpg(HopfConfig.of_article(), batch=batch)
    singles = {index: Cpg(HopfConfig.of_article()) for index in np.ndindex(batch)}
    for action in actions(3, 40, *batch):
        targets = fleet.advance(command_from_action(action, reading, RANGES))
        assert targets.shape == (*batch, robot.SUBSTEPS, 18)
        for index, single in singles.items():
            alone = single.advance(command_from_action(action[index], reading, RANGES))
            np.testing.assert_array_equal(alone, targets[index])
            np.testing.assert_array_equal(single.x, fleet.x[index])
            np.testing.assert_array_equal(single.y, fleet.y[index])


def test_state_survives_changes_of_the_targets() -> None:
    cpg, other = Cpg(HopfConfig.of_article()), Cpg(HopfConfig.of_article())
    command = command_from_action(actions(4), 'D1', RANGES)
    cpg.advance(command)[:] = 0.0
    other.advance(command)
    np.testing.assert_array_equal(cpg.advance(command), other.advance(command))


@pytest.mark.parametrize('field', COMMAND_FIELDS)
@pytest.mark.parametrize('value', [np.nan, np.inf])
def test_command_that_is_not_finite_is_named_and_changes_nothing(field: str, value: float) -> None:
    cpg = Cpg(HopfConfig.of_article())
    good = command_from_action(actions(5), 'D1', RANGES)
    spoilt = getattr(good, field).copy()
    spoilt[2] = value
    with (
        np.errstate(invalid='ignore', over='ignore'),
        pytest.raises(ValueError, match=f'command {field}: expected finite values'),
    ):
        cpg.advance(dataclasses.replace(good, **{field: spoilt}))
    np.testing.assert_array_equal((cpg.x, cpg.y), start_state(HopfConfig.of_article()))


def test_command_that_the_integration_cannot_follow_is_refused() -> None:
    cpg = Cpg(HopfConfig.of_article())
    wild = dataclasses.replace(command_from_action(actions(6), 'D1', RANGES), mu=np.full(6, 1e30))
    with (
        np.errstate(invalid='ignore', over='ignore'),
        pytest.raises(ValueError, match='values that the integration can follow'),
    ):
        cpg.advance(wild)


@pytest.mark.parametrize('field', COMMAND_FIELDS)
def test_command_of_another_shape_is_named(field: str) -> None:
    good = command_from_action(actions(7), 'D1', RANGES)
    with pytest.raises(ValueError, match=rf'command {field}: expected shape \(6,\), got \(5,\)'):
        Cpg(HopfConfig.of_article()).advance(dataclasses.replace(good, **{field: np.zeros(5)}))
