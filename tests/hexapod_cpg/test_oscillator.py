# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The Hopf network against closed forms, and the gaits against the leg order."""

import dataclasses
import math

import numpy as np
import pytest
from hexapod_cpg.oscillator import GAITS, HopfConfig, start_state, step, trajectory

from hexapod_sim import robot

PERIOD_S = robot.CONTROL_PERIOD_NS * 1e-9
SUBSTEP_S = robot.TARGET_PERIOD_NS * 1e-9
OMEGA = 2 * math.pi / 0.6
SINGLE = HopfConfig.of_article(coupling=0.0)
MU = np.ones(6)
FREQUENCY = np.full(6, OMEGA)


def run(
    config: HopfConfig, x: np.ndarray, y: np.ndarray, periods: int, frequency: float = OMEGA
) -> tuple[np.ndarray, np.ndarray]:
    """Every sub-step of a run at mu = 1: two arrays (periods * SUBSTEPS, 6)."""
    rows = []
    for _ in range(periods):
        xs, ys = trajectory(x, y, MU, np.full(6, frequency), config)
        rows.append((xs, ys))
        x, y = xs[-1], ys[-1]
    return tuple(np.concatenate(column) for column in zip(*rows, strict=True))


def mean_phase_error(xs: np.ndarray, ys: np.ndarray, config: HopfConfig) -> float:
    """Largest phase error, averaged over the last five cycles of 0.6 s.

    The coupling acts on y alone, so legs that are neither in phase nor opposed shift one another
    to and fro within a cycle (by 0.1 rad); the gait is what remains on average.
    """
    cycles = slice(-round(5 * 0.6 / SUBSTEP_S), None)
    return float(np.abs(phase_error(xs[cycles], ys[cycles], config).mean(axis=0)).max())


def phase_error(x: np.ndarray, y: np.ndarray, config: HopfConfig) -> np.ndarray:
    """Phases relative to the gait's, less that of the first leg, wrapped to +-pi (..., 6)."""
    relative = np.arctan2(y, x) - np.array(GAITS[config.gait].phases)
    relative -= relative[..., :1]
    return np.angle(np.exp(1j * relative))


def test_radius_follows_the_closed_form_of_one_hopf_oscillator() -> None:
    # With alpha = beta and no coupling: r^2(t) = mu / (1 + (mu / r0^2 - 1) exp(-2 alpha mu t)).
    mu = np.array([0.5, 0.8, 1.0, 1.2, 1.5, 2.0])
    r0 = np.array([0.2, 1.5, 0.5, 0.9, 2.0, 0.1])
    x, y = r0, np.zeros(6)
    for period in range(1, 13):
        x, y = step(x, y, mu, FREQUENCY, SINGLE)
        t = period * PERIOD_S
        expected = np.sqrt(mu / (1 + (mu / r0**2 - 1) * np.exp(-2 * SINGLE.alpha * mu * t)))
        np.testing.assert_allclose(np.hypot(x, y), expected, rtol=2e-3)


def test_phase_advances_by_the_frequency() -> None:
    # Without coupling the phase is omega t, whatever the radius does.
    frequency = np.array([2.0, 5.0, 8.0, 10.0, 12.0, 15.0])
    x, y = np.ones(6), np.zeros(6)
    for _ in range(4):
        x, y = step(x, y, MU, frequency, SINGLE)
    np.testing.assert_allclose(np.arctan2(y, x) % (2 * np.pi), 4 * PERIOD_S * frequency, rtol=1e-5)


def test_integration_is_of_fourth_order_in_the_sub_step() -> None:
    # All rates divided by two over twice as many periods is the same motion in half the step:
    # the error of the classical Runge-Kutta method falls by about 2^4. On the limit cycle the
    # exact solution is a rotation by omega t.
    def error(factor: int) -> float:
        x, y = np.ones(6), np.zeros(6)
        config = HopfConfig.of_article(alpha=20.0 / factor, beta=20.0 / factor, coupling=0.0)
        for _ in range(4 * factor):
            x, y = step(x, y, MU, np.full(6, 40.0 / factor), config)
        return float(abs(x[0] - math.cos(4.0)) + abs(y[0] - math.sin(4.0)))

    assert 1e-6 < error(1) < 1e-3
    assert 14 < error(1) / error(2) < 18


def test_limit_cycle_is_kept_without_coupling() -> None:
    x, y = start_state(SINGLE)
    xs, ys = run(SINGLE, x, y, 200)
    np.testing.assert_allclose(np.hypot(xs, ys), 1.0, atol=1e-5)


def test_coupled_limit_cycle_and_period() -> None:
    # Locked, every Delta_ji is y_i, so y grows by an extra 5 delta y. Averaged over a turn the
    # squared radius settles near mu + 5 delta / (alpha + beta) = 1.0625; the period is longer by
    # less than one percent.
    config = HopfConfig.of_article()
    xs, ys = run(config, *start_state(config), 800)
    settled = slice(1000, None)
    squared = (xs**2 + ys**2)[settled]
    assert squared.mean() == pytest.approx(1.0 + 5 * 0.5 / 40, abs=0.01)
    assert np.sqrt(squared.max()) < 1.06
    turns = np.unwrap(np.arctan2(ys[settled, 0], xs[settled, 0]))
    period = 2 * np.pi * (len(turns) - 1) * SUBSTEP_S / (turns[-1] - turns[0])
    assert 0.6 < period < 0.606


@pytest.mark.parametrize('gait', GAITS)
@pytest.mark.parametrize('seed', [0, 1, 2])
def test_gait_returns_from_perturbed_phases(gait: str, seed: int) -> None:
    config = HopfConfig.of_article(gait=gait)
    rng = np.random.default_rng(seed)
    phase = np.array(GAITS[gait].phases) + rng.uniform(-0.8, 0.8, 6)
    radius = rng.uniform(0.5, 1.5, 6)
    x, y = radius * np.cos(phase), radius * np.sin(phase)
    assert np.abs(phase_error(x, y, config)).max() > 0.3
    xs, ys = run(config, x, y, 400)
    assert mean_phase_error(xs, ys, config) < 0.01
    assert np.abs(phase_error(xs[-1], ys[-1], config)).max() < 0.12


def test_uncoupled_legs_do_not_return() -> None:
    x, y = start_state(SINGLE)
    x[0], y[0] = math.cos(2.5), math.sin(2.5)
    before = phase_error(x, y, SINGLE)
    xs, ys = run(SINGLE, x, y, 100)
    np.testing.assert_allclose(phase_error(xs[-1], ys[-1], SINGLE), before, atol=1e-6)


@pytest.mark.parametrize('gait', GAITS)
def test_start_is_on_the_limit_cycle_in_the_gaits_phases(gait: str) -> None:
    config = HopfConfig.of_article(gait=gait)
    x, y = start_state(config)
    np.testing.assert_allclose(np.hypot(x, y), 1.0, rtol=1e-15)
    np.testing.assert_allclose(phase_error(x, y, config), 0.0, atol=1e-12)
    xs, ys = run(config, x, y, 200)
    assert np.abs(phase_error(xs, ys, config)).max() < 0.2
    assert mean_phase_error(xs, ys, config) < 0.05


def test_tripod_joins_the_legs_of_a_tripod() -> None:
    # Support triangles: front and rear of one side with the middle of the other.
    x, y = start_state(HopfConfig.of_article(start_phase=0.3))
    phase = dict(zip(robot.LEGS, np.arctan2(y, x), strict=True))
    for legs in (('lf', 'lr', 'rm'), ('rf', 'rr', 'lm')):
        assert np.ptp([phase[leg] for leg in legs]) < 1e-12
    assert abs(phase['lf'] - phase['rf']) == pytest.approx(np.pi)


def test_tetrapod_swings_diagonal_pairs_from_rear_to_front() -> None:
    phases = dict(zip(robot.LEGS, GAITS['tetrapod'].phases, strict=True))
    assert {phases['lr'], phases['rf']} == {0.0}
    assert phases['lm'] == phases['rr'] == pytest.approx(-2 * np.pi / 3)
    assert phases['lf'] == phases['rm'] == pytest.approx(-4 * np.pi / 3)


def test_wave_swings_one_leg_after_another_from_rear_to_front() -> None:
    phases = dict(zip(robot.LEGS, GAITS['wave'].phases, strict=True))
    order = sorted(phases, key=lambda leg: -phases[leg])
    assert order == ['lr', 'lm', 'lf', 'rr', 'rm', 'rf']
    np.testing.assert_allclose(np.diff(sorted(phases.values())), np.pi / 3)


def test_duty_factors_are_those_of_the_gaits() -> None:
    # Share of the cycle on the ground: 3, 4 and 5 of 6 legs stand at any time.
    assert {name: gait.duty_factor for name, gait in GAITS.items()} == {
        'tripod': 3 / 6,
        'tetrapod': 4 / 6,
        'wave': 5 / 6,
    }


@pytest.mark.parametrize('gait', GAITS)
def test_swing_and_stance_take_the_shares_of_the_duty_factor(gait: str) -> None:
    config = HopfConfig.of_article(gait=gait, coupling=0.0, swing_stance=True)
    frequency = 2 * np.pi / 2.0
    _, ys = run(config, *start_state(config), 1600, frequency)
    # 40 s are 20 cycles of 2 s. The change between the two speeds is smooth, hence the tolerance.
    assert (ys > 0).mean() == pytest.approx(GAITS[gait].duty_factor, abs=0.01)
    rises = np.count_nonzero((ys[:-1, 0] < 0) & (ys[1:, 0] >= 0))
    assert rises == pytest.approx(20, abs=1)


def test_foot_moves_forwards_in_swing() -> None:
    # y < 0 is swing: there x must grow.
    config = HopfConfig.of_article()
    xs, ys = run(config, *start_state(config), 100)
    growth = np.diff(xs, axis=0)
    assert np.all(growth[ys[:-1] < -0.1] > 0)
    assert np.all(growth[ys[:-1] > 0.1] < 0)


@pytest.mark.parametrize('swing_stance', [False, True])
def test_batches_repeat_single_robots_to_the_last_bit(swing_stance: bool) -> None:
    config = HopfConfig.of_article(gait='wave', swing_stance=swing_stance)
    rng = np.random.default_rng(3)
    shape = (2, 5, 6)
    x, y = rng.uniform(-1, 1, (2, *shape))
    mu, frequency = rng.uniform(0.7, 1.3, shape), rng.uniform(8, 13, shape)
    xs, ys = trajectory(x, y, mu, frequency, config)
    assert xs.shape == ys.shape == (2, 5, robot.SUBSTEPS, 6)
    for index in np.ndindex(2, 5):
        single = trajectory(x[index], y[index], mu[index], frequency[index], config)
        np.testing.assert_array_equal(single[0], xs[index])
        np.testing.assert_array_equal(single[1], ys[index])


def test_a_trajectory_gone_through_before_is_the_same_and_nobody_can_spoil_it() -> None:
    config = HopfConfig.of_article()
    x, y = start_state(config)
    first, again = (trajectory(x, y, MU, FREQUENCY, config) for _ in range(2))
    computed = trajectory(*(each[None] for each in (x, y, MU, FREQUENCY)), config)
    for part, repeated, expected in zip(first, again, computed, strict=True):
        np.testing.assert_array_equal(part, expected[0])
        np.testing.assert_array_equal(repeated, expected[0])
        with pytest.raises(ValueError, match='read-only'):
            part += 1.0
    other = trajectory(x, y, MU, np.nextafter(FREQUENCY, 0.0), config)
    assert (other[0] != first[0]).any()


def test_arguments_are_left_alone() -> None:
    x, y = start_state(HopfConfig.of_article())
    arguments = (x, y, MU.copy(), FREQUENCY.copy())
    copies = [argument.copy() for argument in arguments]
    step(*arguments, HopfConfig.of_article())
    for argument, copy in zip(arguments, copies, strict=True):
        np.testing.assert_array_equal(argument, copy)


def test_step_is_the_end_of_the_trajectory() -> None:
    config = HopfConfig.of_article()
    x, y = start_state(config)
    xs, ys = trajectory(x, y, MU, FREQUENCY, config)
    end = step(x, y, MU, FREQUENCY, config)
    np.testing.assert_array_equal(end, (xs[-1], ys[-1]))


def test_derivative_matches_the_equations_leg_by_leg() -> None:
    # A tiny sub-step of the network against the sums as they are written in the module.
    config = HopfConfig.of_article(gait='tetrapod', alpha=7.0, beta=13.0, coupling=0.9)
    rng = np.random.default_rng(5)
    x, y = rng.uniform(-1, 1, (2, 6))
    mu, omega = rng.uniform(0.5, 1.5, 6), rng.uniform(5, 15, 6)
    phi = GAITS['tetrapod'].phases
    scale = 1e-4  # rates scaled down make the period's increment a derivative
    slow = dataclasses.replace(config, alpha=7e-4, beta=13e-4, coupling=0.9e-4)
    x_end, y_end = step(x, y, mu, omega * scale, slow)
    for i in range(6):
        squared = x[i] ** 2 + y[i] ** 2
        coupling = sum(
            y[j] * math.cos(phi[j] - phi[i]) - x[j] * math.sin(phi[j] - phi[i])
            for j in range(6)
            if j != i
        )
        dx = 7.0 * (mu[i] - squared) * x[i] - omega[i] * y[i]
        dy = 13.0 * (mu[i] - squared) * y[i] + omega[i] * x[i] + 0.9 * coupling
        assert (x_end[i] - x[i]) / (scale * PERIOD_S) == pytest.approx(dx, rel=1e-3, abs=1e-3)
        assert (y_end[i] - y[i]) / (scale * PERIOD_S) == pytest.approx(dy, rel=1e-3, abs=1e-3)


def test_unknown_gait_is_named() -> None:
    with pytest.raises(ValueError, match="gait 'gallop': expected one of tripod, tetrapod, wave"):
        HopfConfig.of_article(gait='gallop')
