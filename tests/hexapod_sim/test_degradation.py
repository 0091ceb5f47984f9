# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Errors of a device have the sizes that were asked for, and come from seed and stamp alone."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hexapod_sim.degradation import Degradation, Distortion, from_rotation, multiply
from hypothesis import given, settings
from hypothesis import strategies as st

STAMPS = [25_000_000 * step for step in range(2000)]
TRUTH = np.linspace(-1.0, 1.0, 6)


def read(distortion: Distortion, seed: int = 1, stream: int = 0) -> np.ndarray:
    """Return what a device reads of the same truth at every stamp (samples, 6)."""
    device = Degradation(distortion, 'vector', seed, stream)
    return np.array([device.apply(TRUTH, stamp) for stamp in STAMPS])


def test_a_perfect_device_reads_the_truth_bit_for_bit() -> None:
    assert Degradation(Distortion(), 'vector', 1).apply(TRUTH, 5).tobytes() == TRUTH.tobytes()


def test_noise_has_its_standard_deviation_and_no_mean() -> None:
    errors = read(Distortion(noise=0.2)) - TRUTH
    # 12000 draws: the standard error of the mean is 0.2 / sqrt(12000) = 0.0018, that of the
    # standard deviation 0.2 / sqrt(24000) = 0.0013; four of them.
    assert abs(errors.mean()) < 0.0073
    assert errors.std() == pytest.approx(0.2, abs=0.0052)
    assert abs(np.corrcoef(errors[:-1, 0], errors[1:, 0])[0, 1]) < 0.1


def test_bias_is_constant_and_differs_between_the_numbers() -> None:
    errors = read(Distortion(bias=0.3)) - TRUTH
    np.testing.assert_allclose(errors - errors[0], 0.0, atol=1e-15)
    assert len(set(errors[0])) == 6
    devices = [Degradation(Distortion(bias=0.3), 'vector', seed) for seed in range(200)]
    drawn = [device.apply(TRUTH, 0) - TRUTH for device in devices]
    assert np.std(drawn) == pytest.approx(0.3, abs=0.025)  # 1200 draws, four standard errors


@given(st.floats(1e-4, 10.0), st.lists(st.floats(-100.0, 100.0), min_size=1, max_size=18))
def test_quantised_values_are_steps_and_within_half_of_one(step: float, truth: list) -> None:
    values = np.array(truth)
    found = Degradation(Distortion(step=step), 'vector', 1).apply(values, 0)
    assert np.abs(found - values).max() <= 0.5 * step * (1.0 + 1e-9)
    np.testing.assert_allclose(found / step, np.round(found / step), atol=1e-6)


@given(st.integers(0, 2**63 - 1), st.permutations(STAMPS[:8]))
def test_an_error_depends_on_seed_and_stamp_alone(seed: int, stamps: list[int]) -> None:
    """Whatever came before, in whatever order, and whoever else asks."""
    distortion = Distortion(noise=0.1, bias=0.2, step=0.001)
    device = Degradation(distortion, 'vector', seed)
    found = {stamp: device.apply(TRUTH, stamp) for stamp in stamps}
    for stamp in stamps:
        again = Degradation(distortion, 'vector', seed).apply(TRUTH, stamp)
        assert found[stamp].tobytes() == again.tobytes()


@pytest.mark.parametrize('other', [{'seed': 2}, {'stream': 1}])
def test_seeds_and_streams_are_independent(other: dict[str, int]) -> None:
    distortion = Distortion(noise=1.0)
    one, two = read(distortion) - TRUTH, read(distortion, **other) - TRUTH
    assert abs(np.corrcoef(one.ravel(), two.ravel())[0, 1]) < 0.04  # four standard errors


@settings(max_examples=50)
@given(st.integers(0, 1000), st.floats(0.0, 0.5), st.floats(0.0, 0.5), st.floats(0.0, 0.5))
def test_orientations_stay_unit_quaternions(seed, noise, bias, step) -> None:
    truth = np.array([0.1, -0.2, 0.3, math.sqrt(1.0 - 0.14)])
    device = Degradation(Distortion(noise, bias, step), 'quaternion', seed)
    assert np.linalg.norm(device.apply(truth, 7)) == pytest.approx(1.0, abs=1e-12)


def test_orientation_noise_is_an_angle_about_each_axis() -> None:
    truth = np.array([0.0, 0.0, math.sin(0.4), math.cos(0.4)])
    device = Degradation(Distortion(noise=0.05), 'quaternion', 3)
    turned = [device.apply(truth, stamp) for stamp in STAMPS]
    inverse = truth * np.array([-1.0, -1.0, -1.0, 1.0])
    # For small angles the vector part of the rotation between them is half the rotation vector.
    errors = 2.0 * np.array([multiply(inverse, q)[:3] for q in turned])
    np.testing.assert_allclose(errors.std(axis=0), 0.05, atol=0.0035)
    assert np.abs(errors.mean(axis=0)).max() < 0.0045


def test_switches_flip_by_chance_and_stay_switches() -> None:
    truth = np.array([0.0, 1.0, 0.0, 1.0, 0.0, 1.0])
    device = Degradation(Distortion(noise=0.1), 'switch', 1)
    found = np.array([device.apply(truth, stamp) for stamp in STAMPS])
    assert set(found.ravel()) == {0.0, 1.0}
    assert (found != truth).mean() == pytest.approx(0.1, abs=0.011)  # four standard errors


@given(st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3))
def test_a_rotation_and_its_inverse_cancel(rotation: list[float]) -> None:
    vector = np.array(rotation)
    product = multiply(from_rotation(vector), from_rotation(-vector))
    np.testing.assert_allclose(product, [0.0, 0.0, 0.0, 1.0], atol=1e-12)


def test_a_quarter_turn_about_z() -> None:
    root = math.sqrt(0.5)
    found = from_rotation(np.array([0.0, 0.0, math.pi / 2]))
    np.testing.assert_allclose(found, [0.0, 0.0, root, root], atol=1e-15)


@pytest.mark.parametrize('wrong', [{'noise': -0.1}, {'bias': math.nan}, {'step': math.inf}])
def test_a_senseless_error_is_refused_by_name(wrong: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=f'{next(iter(wrong))} .*expected a number'):
        Distortion(**wrong)


def test_an_orientation_of_too_coarse_steps_is_refused() -> None:
    with pytest.raises(ValueError, match=r'expected at most 0\.5 for an orientation'):
        Degradation(Distortion(step=0.6), 'quaternion', 1)
