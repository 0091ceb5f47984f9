# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which row goes to whom, what counts as done, and folders that cannot be written."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from hexapod_doe.campaigns.campaign import Campaign
from hexapod_doe.campaigns.campaign_lock import campaign_lock
from hexapod_doe.campaigns.row import Row
from hexapod_doe.designs.factor import sensors
from hexapod_doe.errors import CampaignError

A, B = '/worker_1', '/worker_2'


@pytest.fixture
def campaign(tmp_path) -> Campaign:
    """Return a campaign of three rows, without a plan."""
    rows = (
        Row(f'case{n}', 'A', n, tmp_path / 'runs' / f'case{n}', {}, sensors('A'), (1,))
        for n in (1, 2, 3)
    )
    return Campaign(tmp_path, tuple(rows), attempts=3)


def taken(campaign: Campaign, worker: str, present=(A, B)) -> str:
    row = campaign.take(worker, present)
    return row.run_id if row else ''


def test_rows_go_out_once_and_in_order(campaign):
    assert [taken(campaign, worker) for worker in (A, B, A, B)] == ['case1', 'case2', 'case3', '']
    campaign.release(campaign.rows[1])
    assert taken(campaign, A) == 'case2'
    assert campaign.reasons == {}


def test_failed_row_goes_to_a_worker_that_has_not_tried_it(campaign):
    assert taken(campaign, A) == 'case1'
    campaign.fail(campaign.rows[0], 'no sample')
    assert taken(campaign, A) == 'case2'
    assert taken(campaign, B) == 'case1'
    campaign.fail(campaign.rows[0], 'no sample')
    # Now that both have, and the third try is left, it goes to any.
    assert taken(campaign, A) == 'case1'
    campaign.fail(campaign.rows[0], 'no sample')
    assert campaign.failed == ['case1']
    assert taken(campaign, B) == 'case3'


def test_failed_row_stays_with_a_worker_that_is_alone(campaign):
    for _ in range(3):
        assert taken(campaign, A, present=[A]) == 'case1'
        campaign.fail(campaign.rows[0], 'no sample')
    assert taken(campaign, A, present=[A]) == 'case2'


def test_row_of_a_worker_that_got_stuck_goes_to_another_and_counts_no_failure(campaign):
    assert taken(campaign, A) == 'case1'
    campaign.release(campaign.rows[0], tried=True)
    assert taken(campaign, A) == 'case2'
    assert taken(campaign, B) == 'case1'
    assert campaign.reasons == {}


def test_finished_means_that_every_row_is_done_or_failed(campaign):
    campaign.done = {'case1', 'case2'}
    assert taken(campaign, A) == 'case3'
    assert not campaign.finished
    for _ in range(3):
        assert not campaign.finished
        campaign.fail(campaign.rows[2], 'no sample')
    assert campaign.finished


def test_row_that_somebody_else_has_completed_is_not_given_out(campaign, write_bag):
    (campaign.directory / 'runs').mkdir()
    write_bag('whole').rename(campaign.rows[0].bag)
    assert taken(campaign, A) == 'case2'
    assert campaign.done == {'case1'}


def test_a_whole_bag_counts_whatever_the_worker_says(campaign, write_bag):
    (campaign.directory / 'runs').mkdir()
    row = campaign.take(A)
    assert not campaign.complete(row, 'the recorder is gone')
    assert campaign.reasons == {'case1': ['the recorder is gone']}
    write_bag('whole').rename(row.bag)
    assert campaign.complete(row, 'the recorder is gone')


@pytest.fixture
def small_disk(tmp_path):
    """Mount a file system of one megabyte; return its folder and a function that remounts it."""
    if shutil.which('mount') is None or os.geteuid() != 0:
        pytest.skip('to mount a file system needs root')
    folder: Path = tmp_path / 'disk'
    folder.mkdir()
    mounted = subprocess.run(
        ['mount', '-t', 'tmpfs', '-o', 'size=1m', 'none', str(folder)],
        capture_output=True,
        check=False,
    )
    if mounted.returncode:
        pytest.skip('this machine does not let tests mount a file system')
    yield folder
    subprocess.run(['umount', '-l', str(folder)], check=True)


def test_full_disk_is_told_before_a_row_is_blamed(campaign, small_disk):
    campaign.directory = small_disk
    (small_disk / 'thesis.pdf').write_bytes(bytes(1 << 19))
    with pytest.raises(CampaignError, match=r'disk: cannot write: No space left on device; what'):
        campaign.check_writable()
    assert list((small_disk / 'runs').iterdir()) == []
    subprocess.run(['mount', '-o', 'remount,size=4m', str(small_disk)], check=True)
    campaign.check_writable()


def test_read_only_folder_is_told_by_name(campaign, small_disk):
    campaign.directory = small_disk
    subprocess.run(['mount', '-o', 'remount,ro', str(small_disk)], check=True)
    with pytest.raises(CampaignError, match='Read-only file system'):
        campaign.check_writable()
    with (
        pytest.raises(CampaignError, match=r'cannot write: Read-only file system.*expected'),
        campaign_lock(small_disk),
    ):
        pass
