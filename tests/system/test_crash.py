# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Whatever process of a campaign is killed, and when: its bags are those of one left alone."""

from __future__ import annotations

import pandas as pd
import pytest

from .short_campaign import SIXTEEN_RUNS, TWO_RUNS, ShortCampaign
from .storm import Storm

pytestmark = pytest.mark.system


def weather(campaign: ShortCampaign, kills: int, seed: int) -> Storm:
    """Let a storm pass over a campaign, then let the campaign come to its end."""
    storm = Storm(campaign.start, campaign.runs, seed)
    for _ in range(kills):
        storm.strike()
    assert storm.manager.wait(300.0) == 0, campaign.shell.output()
    return storm


def test_three_kills_change_no_result(shell) -> None:
    campaign = ShortCampaign(shell, shell.directory / 'campaign', TWO_RUNS, 32)
    weather(campaign, kills=3, seed=1)
    campaign.assert_as_alone()


@pytest.mark.slow
@pytest.mark.timeout(3600)
def test_fifty_kills_change_no_result(shell, capsys) -> None:
    calm = ShortCampaign(shell, shell.directory / 'calm', SIXTEEN_RUNS, 40)
    assert calm.start().wait(600.0) == 0, shell.output()
    campaign = ShortCampaign(shell, shell.directory / 'stormy', SIXTEEN_RUNS, 40)
    storm = weather(campaign, kills=50, seed=2026)
    found, expected = campaign.results(), calm.results()
    assert found.keys() == expected.keys()
    assert len(found) == 16
    for run_id, results in expected.items():
        pd.testing.assert_frame_equal(found[run_id], results, check_exact=True)
    assert not list(campaign.runs.glob('*.cut_*'))  # rows that are done need none
    with capsys.disabled():
        print(f'\nkilled: {dict(storm.killed)}; 16 of 16 bags equal')
