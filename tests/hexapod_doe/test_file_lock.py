# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Where a file system locks no files, one line names the folder, and nothing is left behind."""

import errno
import fcntl
import os

import pytest
from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.campaigns.campaign_lock import campaign_lock, row_lock
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.progress import State
from hexapod_doe.errors import BagError, CampaignError

PLAN = """\
StdOrder,RunOrder,case,replicate,seed,run_id,observations,A,B
1,1,1,1,11,r1,,-1,-1
"""
# What flock(2) answers: no such call, not on this device, no locks left, not for this file.
ANSWERS = (errno.ENOSYS, errno.EOPNOTSUPP, errno.ENOLCK, errno.EINVAL)


@pytest.fixture(params=ANSWERS, ids=errno.errorcode.get)
def no_flock(request, monkeypatch) -> None:
    """A file system without flock."""

    def refuse(file: object, operation: int) -> None:
        raise OSError(request.param, os.strerror(request.param))

    monkeypatch.setattr(fcntl, 'flock', refuse)


def test_a_campaign_names_its_folder(no_flock, tmp_path) -> None:
    for held in (campaign_lock(tmp_path), row_lock(tmp_path / 'runs' / 'r1')):
        with pytest.raises(CampaignError, match='flock') as raised, held:
            pass
        assert str(tmp_path) in str(raised.value)
        assert 'expected a folder where files can be locked' in str(raised.value)


def test_a_bag_names_its_folder_and_leaves_nothing(no_flock, tmp_path) -> None:
    with pytest.raises(BagError, match='flock') as raised:
        BagWriter(tmp_path / 'bag', {})
    assert str(tmp_path) in str(raised.value)
    assert list(tmp_path.iterdir()) == []


def test_a_copied_campaign_can_be_looked_at(no_flock, tmp_path) -> None:
    (tmp_path / 'plan.csv').write_text(PLAN)
    cut = tmp_path / 'runs' / 'r1.partial' / 'r1_0.mcap'
    cut.parent.mkdir(parents=True)
    cut.write_bytes(b'\x89MCAP0\r\n')
    (run,) = read_progress(tmp_path).runs.values()
    assert run.state is State.INTERRUPTED
