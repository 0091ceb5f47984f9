# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The noise is MATLAB's process, checked against its moments."""

import numpy as np
import pytest
from hexapod_agent.algorithms.noise import NoiseConfig, OrnsteinUhlenbeckNoise


def make(size: int = 1, sample_time: float = 0.025, **changes: float) -> OrnsteinUhlenbeckNoise:
    values = {'attraction': 0.15, 'sigma': 0.1, 'mean': 0.0, 'decay': 0.0, 'sigma_min': 0.0}
    generator = np.random.default_rng(7)
    return OrnsteinUhlenbeckNoise(NoiseConfig(**values | changes), size, sample_time, generator)


def test_first_step_is_sigma_root_ts_times_a_normal_number():
    drive = np.random.default_rng(7).standard_normal(3)
    np.testing.assert_array_equal(make(3).sample(), 0.1 * np.sqrt(0.025) * drive)


def test_without_drive_the_mean_attracts_by_theta_ts():
    noise = make(sigma=0.0, mean=1.0, attraction=2.0)
    noise.value = np.zeros(1)
    # 1 - (1 - 2 0.025)² = 0.0975 after two steps.
    noise.sample()
    assert noise.sample()[0] == pytest.approx(0.0975)


def test_stationary_deviation():
    noise = make(20_000, sample_time=1.0, attraction=0.5)
    for _ in range(60):
        noise.sample()
    # var = sigma² / (1 - (1 - theta)²) = 0.01 / 0.75 for Ts = 1.
    assert noise.value.std() == pytest.approx(np.sqrt(0.01 / 0.75), rel=0.02)


def test_sigma_decays_to_its_floor():
    noise = make(decay=0.5, sigma_min=0.03)
    sigmas = []
    for _ in range(3):
        noise.sample()
        sigmas.append(noise.sigma)
    assert sigmas == pytest.approx([0.05, 0.03, 0.03])


def test_reset_returns_to_the_mean_and_keeps_the_decayed_sigma():
    noise = make(4, decay=0.1, mean=0.2)
    noise.sample()
    noise.reset()
    np.testing.assert_array_equal(noise.value, np.full(4, 0.2))
    assert noise.sigma == pytest.approx(0.09)
