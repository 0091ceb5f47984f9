# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The doctor tells what keeps nodes apart, with its cure; where they talk, nothing is wrong."""

import fcntl
from pathlib import Path

import pytest
from hexapod_bringup import doctor
from hexapod_bringup.doctor import FINE, NOTE, WRONG


@pytest.mark.graph
def test_where_the_suite_runs_nothing_is_wrong(capsys: pytest.CaptureFixture[str]) -> None:
    assert doctor.main([]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line[7:22].strip() for line in lines] == list(doctor.CHECKS)
    assert lines[-1].startswith('fine   nodes talk       a process hears another after')


@pytest.mark.parametrize(
    ('check', 'environment', 'state', 'text'),
    [
        (doctor.ros, {'ROS_DISTRO': 'humble'}, WRONG, 'humble is sourced'),
        (doctor.variables, {}, FINE, 'none'),
        (doctor.variables, {'ROS_LOCALHOST_ONLY': '1'}, WRONG, 'overrides the discovery range'),
        (doctor.variables, {'RMW_IMPLEMENTATION': 'rmw_gone_cpp'}, WRONG, 'is not installed here'),
        (doctor.variables, {'ROS_STATIC_PEERS': 'far'}, NOTE, 'ROS_STATIC_PEERS=far'),
        (
            doctor.variables,
            {'FASTRTPS_DEFAULT_PROFILES_FILE': '/gone.xml'},
            WRONG,
            '/gone.xml: no such file',
        ),
        (doctor.domain, {'ROS_DOMAIN_ID': '101'}, FINE, '101'),
        (doctor.domain, {'ROS_DOMAIN_ID': '102'}, WRONG, 'ROS_DOMAIN_ID=102'),
        (doctor.domain, {'ROS_DOMAIN_ID': 'lab'}, WRONG, 'ROS_DOMAIN_ID=lab'),
        (doctor.discovery_range, {}, FINE, 'SUBNET'),
        (doctor.discovery_range, {'ROS_AUTOMATIC_DISCOVERY_RANGE': 'OFF'}, WRONG, 'do not find'),
        (doctor.discovery_range, {'ROS_AUTOMATIC_DISCOVERY_RANGE': 'HERE'}, WRONG, 'HERE is none'),
    ],
)
def test_a_variable_that_keeps_nodes_apart_is_named(check, environment, state, text) -> None:
    found = check(environment)
    assert found.state == state
    assert text in found.text
    assert bool(found.cure) == (state != FINE)


def test_multicast_is_needed_beyond_this_machine_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, '_multicast_arrives', lambda: False)
    assert doctor.multicast({'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST'}).state == NOTE
    far = doctor.multicast({'ROS_AUTOMATIC_DISCOVERY_RANGE': 'SUBNET'})
    assert far.state == WRONG
    assert 'ROS_STATIC_PEERS' in far.cure


def test_segments_of_killed_nodes_are_counted_and_living_ones_are_not(tmp_path: Path) -> None:
    living, abandoned = tmp_path / 'fastrtps_1_el', tmp_path / 'fastrtps_2_el'
    abandoned.touch()
    with living.open('wb') as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        found = doctor.shared_memory(tmp_path)
    assert found.state == NOTE
    assert found.text.startswith('1 segments of nodes that were killed')
    abandoned.unlink()
    living.unlink()
    assert doctor.shared_memory(tmp_path).state == FINE


def test_a_full_disk_and_a_foreign_folder_are_wrong(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert doctor.disk(tmp_path).state == FINE
    monkeypatch.setattr(doctor, '_LEAST_DISK', 1e18)
    assert doctor.disk(tmp_path).state == WRONG
    monkeypatch.setattr(doctor.os, 'access', lambda *_: False)
    assert 'cannot be written' in doctor.disk(tmp_path).text


def test_what_is_wrong_ends_with_status_one(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    sick = {'heart': lambda: doctor.Finding(WRONG, '[stopped]', 'beat')}
    monkeypatch.setattr(doctor, 'CHECKS', sick)
    assert doctor.main([]) == 1
    assert capsys.readouterr().out == 'wrong  heart            [stopped]: beat\n'
