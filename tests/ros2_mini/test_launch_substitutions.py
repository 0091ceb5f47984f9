# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from pathlib import Path

import pytest
from ros2_mini.launch.substitutions import (
    Substitution,
    SubstitutionError,
    as_bool,
    evaluate,
    parse,
)

CONFIGURATIONS = {'who': 'world', 'name': 'who', 'yes': 'true', 'spaced': 'a b', 'a)b': 'c'}
FILE = Path('/ws/launch/demo.launch.xml')


def value(text: str) -> str:
    return evaluate(parse(text), CONFIGURATIONS, FILE)


def test_text_without_substitutions_is_itself():
    assert parse('plain $ text (5)') == ('plain $ text (5)',)
    assert parse('') == ()


def test_arguments_may_be_quoted_nested_and_adjacent():
    assert parse('a$(f X "b c")d') == ('a', Substitution('f', (('X',), ('b c',))), 'd')
    assert parse('$(var $(var name))') == (
        Substitution('var', ((Substitution('var', (('name',),)),),)),
    )


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        ('hello $(var who)!', 'hello world!'),
        ('$(var $(var name))', 'world'),
        ("$(equals '$(var who) and all' 'world and all')", 'true'),
        ('$(dirname)/a.yaml', '/ws/launch/a.yaml'),
        ('$(equals $(var who) world)', 'true'),
        ('$(equals $(var spaced) world)', 'false'),
        ('$(equals 1 true)', 'true'),  # both are conditions
        ('$(equals 1.0 1.00)', 'true'),  # both are numbers
        ('$(equals 1.0 true)', 'false'),
        ('\\$(var who)', '$(var who)'),
        ('$(var a\\)b)', 'c'),
    ],
)
def test_value(text: str, expected: str):
    assert value(text) == expected


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('$(var who', r"column 10: expected '\)'"),
        ('$(var  who)', 'expected an argument'),  # two spaces: the launch library refuses it too
        ("$(var 'who)", "expected '"),
        ('$()', 'expected the name of a substitution'),
        ('$(eval 1+1)', r'\$\(eval\) is not supported; supported: dirname, equals'),
        ('$(var)', r'\$\(var\) has 0 argument\(s\), expected 1'),
        ('$(dirname x)', 'has 1 argument.*expected 0'),
        ('$(var missing)', "launch configuration 'missing' does not exist"),
        ('$(find-pkg-share no_such_package)', "Package 'no_such_package' not found"),
    ],
)
def test_error_names_what_is_wrong(text: str, message: str):
    with pytest.raises(SubstitutionError, match=message):
        value(text)


def test_package_directories(prefix):
    assert value('$(find-pkg-share demo)/x') == f'{prefix.root}/share/demo/x'


def test_what_is_no_condition_is_named():
    with pytest.raises(SubstitutionError, match="'maybe' is no condition, expected true, 1, fal"):
        as_bool('maybe')


@pytest.mark.parametrize('text', ['true', 'True', ' 1 ', 'TRUE'])
def test_conditions_that_hold(text: str):
    assert as_bool(text)
