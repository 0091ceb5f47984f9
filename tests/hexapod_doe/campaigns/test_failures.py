# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Failed tries outlive the manager that saw them, and no more than that one."""

from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta

from hexapod_doe.campaigns.failures import FailureLog, read_failures


def test_reasons_come_back_in_their_order(tmp_path):
    log = FailureLog(tmp_path)
    assert read_failures(tmp_path) == {}
    log.add('case01', '/worker_1', 'sim/reset: "odd", and\ntwo lines')
    log.add('case02', '/worker_2', 'disk')
    log.add('case01', '/worker_2', 'again')
    assert read_failures(tmp_path) == {
        'case01': ['sim/reset: "odd", and\ntwo lines', 'again'],
        'case02': ['disk'],
    }


def test_next_manager_begins_without_failures(tmp_path):
    FailureLog(tmp_path).add('case01', '/worker_1', 'disk')
    FailureLog(tmp_path).clear()
    assert read_failures(tmp_path) == {}


def test_failures_of_earlier_tries_can_be_left_out(tmp_path):
    FailureLog(tmp_path).add('case01', '/worker_1', 'disk')
    now = datetime.now(UTC)
    assert read_failures(tmp_path, now - timedelta(minutes=1)) == {'case01': ['disk']}
    assert read_failures(tmp_path, now + timedelta(minutes=1)) == {}


def test_failures_that_come_at_once_share_one_header(tmp_path):
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda n: FailureLog(tmp_path).add(f'case{n}', '/w', 'disk'), range(50)))
    assert read_failures(tmp_path) == {f'case{n}': ['disk'] for n in range(50)}
