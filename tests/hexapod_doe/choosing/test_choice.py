# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.choosing.choice import decide, expected_loss
from hexapod_doe.designs.design import fraction
from hexapod_doe.records.options import Options
from simulated import Truth, repeated_levels, table_of


def test_what_is_decided_alone_is_what_the_analysis_decides() -> None:
    levels = repeated_levels(fraction('eighth'), 4)
    table = table_of(levels, Truth().simulate(levels, np.random.default_rng(2)))
    whole, alone = analyse([table], Options()), decide(table, Options())
    assert whole.two_part is not None
    assert alone.ranking[0] == whole.choice
    assert alone.ranking == whole.two_part.ranking
    assert expected_loss(alone, Options().seed) == whole.expected_loss


def test_a_choice_is_expected_to_lose_less_after_more_runs() -> None:
    truth = Truth(success={'1': 400, 'A': 12, 'B': 6, 'C': -9}, failure={'1': -50.0})
    loss = []
    for runs in (3, 30):
        levels = repeated_levels(fraction('eighth'), runs)
        table = table_of(levels, truth.simulate(levels, np.random.default_rng(1)))
        found = expected_loss(decide(table, Options()), seed=1)
        assert found is not None
        loss.append(found)
    assert loss[0] > loss[1] >= 0
