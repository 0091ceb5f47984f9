# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import pytest
from ros2_mini.cli import main
from ros2_mini.errors import CommandError
from ros2_mini.launch.arguments import declarations, parse_launch_arguments


def test_last_value_wins():
    assert parse_launch_arguments(['a:=1', 'b:=x:=y', 'a:=2']) == {'a': '2', 'b': 'x:=y'}


@pytest.mark.parametrize('word', ['a', 'a=1', ':=1', 'a:='])
def test_malformed_argument(word: str):
    with pytest.raises(CommandError, match=f"malformed launch argument '{word}', expected format"):
        parse_launch_arguments([word])


def test_arguments_of_groups_and_includes_are_found(prefix):
    prefix.add_launch_file('<arg name="deep"/><arg name="a" default="2"/>', 'inner.launch.xml')
    path = prefix.add_launch_file("""<arg name="a" default="1"/>
    <group if="true"><arg name="b"/></group>
    <include file="$(dirname)/inner.launch.xml"/><include file="$(var b)/x.launch.xml"/>""")
    found = declarations(path)
    assert [(one.name, one.conditional) for one in found] == [
        ('a', False), ('b', True), ('deep', False),
    ]  # fmt: skip


# As `ros2 launch --show-args` of ros2launch 0.26.6 prints the same file.
SHOWN = """Arguments (pass arguments as '<name>:=<value>'):

    'who':
        Whom to greet
        (default: 'world')

    'x':*
        no description given
        (default: LaunchConfig('who') + '-' + ThisLaunchFileDir() + '/a')

    'y':
        no description given
        (default: '')

* argument(s) which are only used if specific conditions occur
"""


def test_arguments_are_shown_as_the_launch_library_does(prefix, capsys):
    prefix.add_launch_file("""<arg name="who" default="world" description="Whom to greet"/>
    <group unless="false"><arg name="x" default="$(var who)-$(dirname)/a"/></group>
    <arg name="y" default=""/>""")
    assert main(['launch', '--show-args', 'demo', 'demo.launch.xml']) == 0
    assert capsys.readouterr().out == SHOWN


def test_file_without_arguments(prefix, capsys):
    path = prefix.add_launch_file('')
    assert main(['launch', '-s', str(path)]) == 0
    assert capsys.readouterr().out.endswith('\n\n  No arguments.\n')
