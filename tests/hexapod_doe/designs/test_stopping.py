# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hexapod_doe.designs.design import fraction
from hexapod_doe.designs.stopping import Expected, expected_runs

from hexapod_doe import plan


def runs(delta: float) -> Expected:
    return expected_runs(fraction('quarter'), 10, 40.0, delta, 3, np.random.default_rng(1))


def test_a_looser_rule_ends_earlier() -> None:
    assert runs(20.0).mean < runs(10.0).mean < runs(5.0).mean < runs(1e-3).mean <= 320
    assert runs(1e6) == Expected(96.0, 96, 96)


def test_many_factors_are_judged_by_some_of_their_sets() -> None:
    design = fraction('half', 'ABCDEFGHJ')
    found = expected_runs(design, 4, 1.0, 1e-6, 3, np.random.default_rng(1))
    assert 768 < found.mean <= found.high == 1024


def test_hours_tells_the_runs_that_a_rule_is_expected_to_take(
    capsys: pytest.CaptureFixture[str],
) -> None:
    words = ['hours', '--hours', '100', '--seconds-per-run', '1000', '--sigma', '40']
    plan.main([*words, '--stop-when', '10'])
    assert 'With --stop-when 10 about' in capsys.readouterr().out
    with pytest.raises(SystemExit):
        plan.main([*words[:-2], '--stop-when', '10'])
    assert '--sigma' in capsys.readouterr().err
