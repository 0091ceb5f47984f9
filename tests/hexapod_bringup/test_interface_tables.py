# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Tables of the documentation are those of the running nodes and of the sensor table."""

import re
from pathlib import Path

import pytest
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.specification.spec_text import flat
from hexapod_doe.studies.study_text import replace_block
from interface_tables import (
    PAGES,
    SAMPLE_BAG,
    metric_table,
    node_tables,
    sensor_table,
)
from specification_tables import Comment, allowed, comment, specification_tables

ROOT = Path(__file__).resolve().parents[2]
CURE = 'run `python tests/support/interface_tables.py`'


def stands(name: str, table: str) -> bool:
    page = (ROOT / PAGES[name]).read_text(encoding='utf-8')
    return replace_block(page, name, table) == page


def test_the_sensor_table_is_that_of_the_code() -> None:
    assert stands('sensors', sensor_table()), CURE


def test_the_metric_table_is_that_of_the_code() -> None:
    assert stands('metrics', metric_table()), CURE


def test_the_keys_of_a_specification_are_those_of_the_code() -> None:
    assert stands('specification', specification_tables()), CURE


def test_every_key_is_listed_with_a_meaning() -> None:
    listed = dict(re.findall(r'^\| `(\S+)` \|(.*)$', specification_tables(), re.MULTILINE))
    keys = flat(RunSpec.load().to_mapping())
    keys = {re.sub(r'^sensors\.\w+', 'sensors.CHANNEL', key) for key in keys}
    assert keys <= set(listed)
    assert all(re.split(r'(?<!\\)\|', row)[3].strip() for row in listed.values())


def test_a_comment_is_parted_into_unit_and_origin() -> None:
    assert comment('1/s. [ours] as alpha') == Comment('1/s', '[ours] as alpha')
    assert comment('[article]') == Comment('', '[article]')
    assert comment('rad/s, a period of 0.6 s') == Comment('rad/s', 'a period of 0.6 s')
    assert comment('reading D2 only') == Comment('', 'reading D2 only')
    assert allowed(bool) == 'true, false'


@pytest.mark.graph
def test_the_interface_tables_are_those_of_the_nodes() -> None:
    assert stands('interfaces', node_tables(ROOT / SAMPLE_BAG)), CURE


def test_missing_markers_are_an_error() -> None:
    with pytest.raises(ValueError, match='no <!-- sensors: begin -->'):
        replace_block('text', 'sensors', 'table')
