# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hexapod_doe.fitting.model import corners
from simulated import Truth

GRID = corners('ABCDEFG')


def test_a_fifth_of_the_runs_fails() -> None:
    assert Truth().p_failure(GRID).mean() == pytest.approx(0.2, abs=0.003)


def test_targets_agree_with_large_samples() -> None:
    truth = Truth()
    point = GRID.iloc[[31] * 300_000]  # ABCDE
    runs = np.sort(truth.simulate(point, np.random.default_rng(1)))
    best = GRID.iloc[[31]]
    assert truth.mean(best)[0] == pytest.approx(runs.mean(), abs=1.5)
    assert truth.iqm(best)[0] == pytest.approx(runs[75_000:225_000].mean(), abs=0.5)
    triples = np.random.default_rng(2).permutation(runs).reshape(-1, 3)
    assert truth.best_of(best, 3)[0] == pytest.approx(triples.max(axis=1).mean(), abs=0.5)
    assert truth.quantiles(best, np.array([0.5]))[0, 0] == pytest.approx(np.median(runs), abs=0.5)
