# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""article.yaml is the only place of its numbers."""

import dataclasses
from typing import get_type_hints

import pytest
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.specification.sections import CpgConfig
from hexapod_cpg.mapping import ActionRanges
from hexapod_cpg.oscillator import HopfConfig
from hexapod_sim.article import section
from hexapod_sim.quality import PERFECT, Quality
from hexapod_sim.task_config import TaskConfig

SECTIONS = {
    TaskConfig: ('task',),
    HopfConfig: ('cpg', 'hopf'),
    ActionRanges: ('cpg', 'ranges'),
    Quality: ('sensors', 'each'),
}


def sections(kind: type) -> list[type]:
    """Return a dataclass and all that are inside it."""
    inner = [hint for hint in get_type_hints(kind).values() if dataclasses.is_dataclass(hint)]
    return [kind, *(each for part in inner for each in sections(part))]


@pytest.mark.parametrize('kind', [*sections(RunSpec), Quality], ids=lambda kind: kind.__name__)
def test_no_field_has_a_second_default(kind) -> None:
    for field in dataclasses.fields(kind):
        assert field.default is dataclasses.MISSING, field.name
        assert field.default_factory is dataclasses.MISSING, field.name


def test_all_sections_are_looked_at() -> None:
    assert {TaskConfig, CpgConfig, HopfConfig, ActionRanges} <= set(sections(RunSpec))


@pytest.mark.parametrize('kind', SECTIONS, ids=lambda kind: kind.__name__)
def test_values_have_the_types_that_their_fields_say(kind) -> None:
    """A node declares its parameters with them: 20 for 20.0 would be a whole number for ever."""
    read, hints = section(*SECTIONS[kind]), get_type_hints(kind)
    assert read.keys() == hints.keys()
    for name, hint in hints.items():
        expected = tuple if hint == tuple[float, float] else hint
        assert type(read[name]) is expected, name


def test_the_agent_has_what_the_packages_below_it_read() -> None:
    config = RunSpec.load()
    assert config.task == TaskConfig.of_article()
    assert config.cpg.hopf == HopfConfig.of_article()
    assert config.cpg.ranges == ActionRanges.of_article()
    assert set(config.sensors.values()) == {PERFECT}


def test_changes_leave_the_article_alone() -> None:
    assert TaskConfig.of_article(max_offset=3.0).max_offset == 3.0
    assert TaskConfig.of_article().max_offset == 2.0
    with pytest.raises(TypeError, match='max_ofset'):
        TaskConfig.of_article(max_ofset=3.0)
