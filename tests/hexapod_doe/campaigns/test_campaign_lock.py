# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""One manager per campaign and one process per row; who died holds nothing."""

import os
import signal
import subprocess
import sys

import pytest
from hexapod_doe.campaigns.campaign_lock import campaign_lock, row_lock
from hexapod_doe.errors import CampaignError

HOLD = """
import sys, time
from pathlib import Path
from hexapod_doe.campaigns.campaign_lock import campaign_lock, row_lock
with campaign_lock(Path(sys.argv[1])):
    print('held', flush=True)
    time.sleep(600)
"""


@pytest.fixture
def holder(tmp_path):
    """Another process that holds the campaign in tmp_path."""
    process = subprocess.Popen(
        [sys.executable, '-c', HOLD, str(tmp_path)], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == 'held\n'
    yield process
    process.kill()
    process.wait()


def test_second_manager_is_told_who_holds_the_campaign(holder, tmp_path):
    for shared in (False, True):
        with pytest.raises(CampaignError) as caught, campaign_lock(tmp_path, shared):
            pass
        text = str(caught.value)
        assert f'campaign {tmp_path}: process {holder.pid} on {os.uname().nodename}' in text
        assert str(tmp_path) in text
        assert 'since 20' in text


@pytest.mark.parametrize('number', [signal.SIGKILL, signal.SIGTERM])
def test_lock_ends_with_its_process(holder, tmp_path, number):
    holder.send_signal(number)
    holder.wait()
    assert (tmp_path / 'campaign.lock').exists()
    with campaign_lock(tmp_path):
        pass


def test_single_rows_share_a_campaign_but_no_row(tmp_path):
    bag = tmp_path / 'runs' / 'case01'
    with campaign_lock(tmp_path, shared=True), campaign_lock(tmp_path, shared=True), row_lock(bag):
        with row_lock(bag.with_name('case02')):
            pass
        with (
            pytest.raises(CampaignError, match='run case01: process'),
            row_lock(bag),
        ):
            pass
        with pytest.raises(CampaignError, match=f'process {os.getpid()}'), campaign_lock(tmp_path):
            pass
    with campaign_lock(tmp_path), row_lock(bag):
        pass


def test_lock_that_nobody_has_signed_still_is_one(holder, tmp_path):
    (tmp_path / 'campaign.lock').write_text('')
    with pytest.raises(CampaignError, match='another process is at it'), campaign_lock(tmp_path):
        pass


def test_error_is_the_callers_own(tmp_path):
    with pytest.raises(KeyError), campaign_lock(tmp_path):
        raise KeyError('of the block')
    with campaign_lock(tmp_path):
        pass
