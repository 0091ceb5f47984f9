# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Tables of the documentation are those of the running nodes and of the sensor table."""

from pathlib import Path

import pytest
from hexapod_doe.studies.study_text import replace_block
from interface_tables import (
    PAGES,
    SAMPLE_BAG,
    metric_table,
    node_tables,
    sensor_table,
)

ROOT = Path(__file__).resolve().parents[2]
CURE = 'run `python tests/support/interface_tables.py`'


def stands(name: str, table: str) -> bool:
    page = (ROOT / PAGES[name]).read_text(encoding='utf-8')
    return replace_block(page, name, table) == page


def test_the_sensor_table_is_that_of_the_code() -> None:
    assert stands('sensors', sensor_table()), CURE


def test_the_metric_table_is_that_of_the_code() -> None:
    assert stands('metrics', metric_table()), CURE


@pytest.mark.graph
def test_the_interface_tables_are_those_of_the_nodes() -> None:
    assert stands('interfaces', node_tables(ROOT / SAMPLE_BAG)), CURE


def test_missing_markers_are_an_error() -> None:
    with pytest.raises(ValueError, match='no <!-- sensors: begin -->'):
        replace_block('text', 'sensors', 'table')
