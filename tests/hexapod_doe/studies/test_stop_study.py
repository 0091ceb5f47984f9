# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pandas as pd
import pytest
from stop_study import DELTAS, drawn_truth, stopped, study, table


def paths() -> pd.DataFrame:
    return pd.DataFrame(
        [(3, 12.0, 9.0, 0.2, 0), (4, 8.0, 2.0, 0.2, 0), (3, 40.0, 7.0, 0.02, 0),
         (4, 35.0, 6.0, 0.02, 0)],
        columns=['replicates', 'expected', 'true', 'share', 'campaign'],
    )  # fmt: skip


def test_a_campaign_ends_at_the_first_look_below_delta_or_with_its_plan() -> None:
    ends = stopped(paths(), 10.0).set_index('share')
    assert ends.loc[0.2, ['replicates', 'true', 'by_rule']].tolist() == [4, 2.0, True]
    assert ends.loc[0.02, ['replicates', 'by_rule']].tolist() == [4, False]


def test_the_table_has_what_is_lost_and_saved() -> None:
    found = table(paths()).set_index(['failing', 'delta'])
    assert len(found) == 2 * len(DELTAS)
    assert found.loc[(0.2, 20.0), ['stopped', 'true']].tolist() == [1.0, 9.0]
    assert found.loc[(0.2, 20.0), 'runs_saved'] == pytest.approx(0.7)


def test_effects_are_drawn_for_each_campaign() -> None:
    first, second = (drawn_truth(0.2, np.random.default_rng(seed)) for seed in (1, 2))
    assert first.success != second.success
    assert len(first.success) == 1 + 7 + 3


@pytest.mark.slow
@pytest.mark.timeout(7200)
def test_what_is_lost_is_below_delta_on_average() -> None:
    """200 campaigns: the table of docs/statistics.md, for either share of failures."""
    found = table(study(200, seed=1))
    seen = found[found['stopped'] > 0.1]
    assert (seen['true'] <= seen['delta']).all()
    assert (found.loc[found['delta'] == max(DELTAS), 'runs_saved'] > 0.3).all()
