# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hexapod_doe.fitting.logistic import firth
from scipy import optimize, special


def test_an_intercept_alone_adds_half_a_failure_and_half_a_success() -> None:
    # Firth's estimate of a proportion is (k + 1/2)/(n + 1).
    outcome = np.array([1.0] * 3 + [0.0] * 17)
    fit = firth(np.ones((20, 1)), outcome)
    assert fit.probability(np.ones((1, 1)))[0] == pytest.approx(3.5 / 21)


def test_two_groups_get_half_a_count_each() -> None:
    # A saturated model shrinks each group on its own.
    matrix = np.column_stack([np.ones(30), np.repeat([-1.0, 1.0], [10, 20])])
    outcome = np.concatenate([[1.0] * 4, [0.0] * 6, [1.0] * 1, [0.0] * 19])
    fit = firth(matrix, outcome)
    assert fit.probability(np.array([[1, -1], [1, 1]])) == pytest.approx([4.5 / 11, 1.5 / 21])


def test_separated_groups_stay_finite() -> None:
    matrix = np.column_stack([np.ones(12), np.repeat([-1.0, 1.0], 6)])
    fit = firth(matrix, np.repeat([0.0, 1.0], 6))
    assert fit.probability(np.array([[1, 1]]))[0] == pytest.approx(6.5 / 7)
    assert np.isfinite(fit.covariance).all()


def test_the_penalised_likelihood_is_at_its_maximum() -> None:
    rng = np.random.default_rng(1)
    matrix = np.column_stack([np.ones(60), rng.choice([-1.0, 1.0], (60, 2))])
    outcome = (rng.random(60) < special.expit(matrix @ [-1.0, 0.8, -0.3])).astype(float)

    def loss(coef: np.ndarray) -> float:
        pi = special.expit(matrix @ coef)
        information = matrix.T @ (matrix * (pi * (1 - pi))[:, None])
        likelihood = (outcome * np.log(pi) + (1 - outcome) * np.log(1 - pi)).sum()
        return -likelihood - 0.5 * np.linalg.slogdet(information)[1]

    found = optimize.minimize(loss, np.zeros(3), method='BFGS', options={'gtol': 1e-8})
    assert firth(matrix, outcome).coef == pytest.approx(found.x, abs=1e-6)


def small_table(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    rows = int(rng.integers(8, 30))
    matrix = np.column_stack([np.ones(rows), rng.choice([-1.0, 1.0], (rows, rng.integers(1, 6)))])
    coef = rng.normal(0, 2, matrix.shape[1])
    return matrix, (rng.random(rows) < special.expit(matrix @ coef)).astype(float)


def test_small_and_separated_tables_converge_to_the_root_of_the_score() -> None:
    # Six of 118 such tables did not converge without halved steps; R's brglm2 fits them all.
    rng = np.random.default_rng(3)
    for _ in range(80):
        matrix, outcome = small_table(rng)
        if np.linalg.matrix_rank(matrix) < matrix.shape[1]:
            continue
        pi = firth(matrix, outcome).probability(matrix)
        half = matrix * np.sqrt(pi * (1 - pi))[:, None]
        leverage = np.diag(half @ np.linalg.inv(half.T @ half) @ half.T)
        score = matrix.T @ (outcome - pi + leverage * (0.5 - pi))
        assert score == pytest.approx(np.zeros(len(score)), abs=1e-6)
