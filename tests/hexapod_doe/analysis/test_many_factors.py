# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Fifteen factors, 32768 sets: what took 3.4 GB is bounded."""

import resource
from itertools import combinations
from multiprocessing import get_context

import numpy as np
import pytest
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.fitting.model import corners
from hexapod_doe.records.options import Options
from simulated import table_of


def _analyse_fifteen_factors() -> tuple[str, float]:
    """Return the choice and the peak of the process's memory, in GB."""
    levels = corners('ABCDE')
    words = [''.join(word) for size in (3, 5, 4) for word in combinations('ABCDE', size)]
    for letter, word in zip('FGHJKLMNOP', words, strict=False):
        levels[letter] = levels[list(word)].prod(axis=1)
    runs = levels.loc[levels.index.repeat(2)].reset_index(drop=True)
    truth = 100 + 10 * runs['A'] + 8 * runs['B'] * runs['C']
    table = table_of(runs, (truth + np.random.default_rng(1).normal(0, 3, len(runs))).to_numpy())
    choice = analyse([table], Options()).choice
    return choice, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_the_memory_of_fifteen_factors_is_bounded() -> None:
    with get_context('spawn').Pool(1) as pool:
        choice, peak = pool.apply(_analyse_fifteen_factors)
    assert choice.startswith('A')
    assert peak < 2.0
