# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The manager ends a campaign by its rule, and begins it again only when somebody says so."""

import json
from pathlib import Path

import pytest
from hexapod_doe.campaigns.stop_rule import STOP_FILE
from simulated import Truth
from simulated_study import finish, plan_campaign

pytestmark = pytest.mark.system
MANAGER = 'ros2 run hexapod_doe manager_node --ros-args -p local_workers:=0 -p worker_timeout:=5.0'


@pytest.mark.timeout(900)
def test_a_campaign_ends_by_its_rule(shell) -> None:
    folder: Path = shell.directory / 'campaign'
    plan = plan_campaign(folder, 'eighth', 4, in_turns=True)
    finish(plan, Truth(failure={'1': -50.0}), seed=1, rows=48)
    ended = shell.run(f'{MANAGER} -p plan:={plan} -p stop_when:=1e6', 180.0)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert 'complete by its rule: after 48 runs' in ended.stdout
    assert json.loads((folder / STOP_FILE).read_text())['stopped']
    again = shell.run(f'{MANAGER} -p plan:={plan}', 180.0)
    assert again.returncode == 0
    assert 'go_on:=true trains the others' in again.stdout
    on = shell.run(f'{MANAGER} -p plan:={plan} -p go_on:=true', 180.0)
    assert on.returncode == 1  # there is no worker to train the others
    assert 'no worker offers the action' in on.stdout
