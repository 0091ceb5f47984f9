# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a process asks of its environment, in this process; tests/system starts real ones."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest
from hexapod_node import environment
from hexapod_node.environment import (
    EnvironmentVariableError,
    check_variables,
    domain_id,
    provide_log_directory,
)


@pytest.fixture
def prefix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The one prefix that has a middleware: rmw_fastrtps_cpp."""
    index = tmp_path / 'share/ament_index/resource_index/rmw_typesupport'
    index.mkdir(parents=True)
    (index / 'rmw_fastrtps_cpp').touch()
    monkeypatch.setattr(sys, 'prefix', str(tmp_path / 'nowhere'))
    monkeypatch.setenv('AMENT_PREFIX_PATH', f'/nowhere::{tmp_path}')
    return index


@pytest.mark.parametrize('name', ['', 'rmw_fastrtps_cpp'])
def test_a_middleware_that_is_there_passes(prefix, monkeypatch, name: str) -> None:
    monkeypatch.setenv('RMW_IMPLEMENTATION', name)
    check_variables()


@pytest.mark.parametrize('name', ['rmw_cyclonedds_cpp', 'rmw_zenoh_cpp', 'fastrtps', '../x'])
def test_a_middleware_that_is_not_there_is_one_line(prefix, monkeypatch, name: str) -> None:
    monkeypatch.setenv('RMW_IMPLEMENTATION', name)
    with pytest.raises(EnvironmentVariableError) as raised:
        check_variables()
    assert str(raised.value).startswith(f"RMW_IMPLEMENTATION='{name}' is not installed")
    assert 'expected rmw_fastrtps_cpp' in str(raised.value)


def test_where_none_is_listed_rcl_judges(prefix, monkeypatch) -> None:
    monkeypatch.setenv('AMENT_PREFIX_PATH', '')
    monkeypatch.setenv('RMW_IMPLEMENTATION', 'rmw_zenoh_cpp')
    check_variables()


@pytest.mark.parametrize(('text', 'domain'), [('', 0), ('0', 0), ('42', 42), ('232', 232)])
def test_domains(monkeypatch, text: str, domain: int) -> None:
    monkeypatch.setenv('ROS_DOMAIN_ID', text)
    assert domain_id() == domain


@pytest.mark.parametrize('text', ['abc', '-1', '1.5', '233', '99999999999999999999', '0x10', '²'])
def test_what_is_no_domain_is_one_line(monkeypatch, text: str) -> None:
    monkeypatch.setenv('ROS_DOMAIN_ID', text)
    with pytest.raises(EnvironmentVariableError, match=r'^ROS_DOMAIN_ID=.*from 0 to 232$'):
        check_variables()


@pytest.fixture
def no_variables(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """An environment that says nothing of logs; what is set in a test goes with it."""
    for name in ('ROS_LOG_DIR', 'ROS_HOME'):
        monkeypatch.setenv(name, '')
    return monkeypatch


@pytest.mark.parametrize(
    ('variable', 'folder'), [('ROS_LOG_DIR', ''), ('ROS_HOME', 'log'), ('HOME', '.ros/log')]
)
def test_the_folder_that_rcl_takes(no_variables, tmp_path, capsys, variable, folder) -> None:
    no_variables.setenv(variable, str(tmp_path))
    assert provide_log_directory() == tmp_path / folder
    assert (tmp_path / folder).is_dir()
    assert capsys.readouterr().err == ''


@pytest.mark.parametrize('home', ['/dev/null', '/proc', None])
def test_without_a_home_logs_go_to_a_temporary_folder(
    no_variables, tmp_path, capsys, home: str | None
) -> None:
    no_variables.setattr(environment.tempfile, 'gettempdir', lambda: str(tmp_path))
    no_variables.setenv('HOME', home) if home else no_variables.delenv('HOME')
    chosen = provide_log_directory()
    assert chosen.parent == tmp_path
    assert os.environ['ROS_LOG_DIR'] == str(chosen)
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('HOME: ')
    assert line.endswith(f'ROS logs go to {chosen}, unless ROS_LOG_DIR is set')
    assert provide_log_directory() == chosen  # and the next process says nothing
    assert capsys.readouterr().err == ''


@pytest.mark.parametrize('variable', ['ROS_LOG_DIR', 'ROS_HOME'])
def test_a_folder_that_was_asked_for_is_not_replaced(no_variables, variable: str) -> None:
    no_variables.setenv(variable, '/dev/null')
    with pytest.raises(EnvironmentVariableError, match=f"^{variable}='/dev/null': .*may write$"):
        provide_log_directory()


def test_no_place_at_all_asks_for_the_variable(no_variables) -> None:
    no_variables.setattr(environment.tempfile, 'gettempdir', lambda: '/dev/null')
    no_variables.setenv('HOME', '/dev/null')
    with pytest.raises(EnvironmentVariableError, match='expected ROS_LOG_DIR to be set'):
        provide_log_directory()
