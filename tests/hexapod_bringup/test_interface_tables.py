# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The README's tables are those of the running nodes and of the sensor table."""

from pathlib import Path

import pytest
from hexapod_bringup.interface_tables import (
    SAMPLE_BAG,
    metric_table,
    node_tables,
    replace,
    sensor_table,
)

ROOT = Path(__file__).resolve().parents[2]
CURE = 'run `python -m hexapod_bringup.interface_tables README.md`'


@pytest.fixture(scope='module')
def readme() -> str:
    return (ROOT / 'README.md').read_text(encoding='utf-8')


def test_the_sensor_table_is_that_of_the_code(readme: str) -> None:
    assert replace(readme, 'sensors', sensor_table()) == readme, CURE


def test_the_metric_table_is_that_of_the_code() -> None:
    page = (ROOT / 'bags' / 'README.md').read_text(encoding='utf-8')
    assert replace(page, 'metrics', metric_table()) == page, CURE


@pytest.mark.graph
def test_the_interface_tables_are_those_of_the_nodes(readme: str) -> None:
    assert replace(readme, 'interfaces', node_tables(ROOT / SAMPLE_BAG)) == readme, CURE


def test_missing_markers_are_an_error() -> None:
    with pytest.raises(ValueError, match='no <!-- sensors: begin -->'):
        replace('text', 'sensors', 'table')
