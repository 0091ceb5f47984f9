# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from pathlib import Path

import pytest
import yaml
from ros2_mini.errors import CommandError
from ros2_mini.launch.expand import expand_launch_file
from ros2_mini.launch.supervisor import Plan, ProcessSpec


@pytest.fixture
def expand(prefix, tmp_path):
    """Expand the body of a launch file into a plan."""
    prefix.add_executable('talker', 'exit 0')

    def expand_body(body: str, **arguments: str) -> Plan:
        path = prefix.add_launch_file(body)
        return expand_launch_file(path, arguments, {'HOME': '/home/me'}, tmp_path)

    return expand_body


@pytest.fixture
def node(expand):
    """Expand a launch file with one node, given what the node holds."""

    def expand_node(attributes: str = '', children: str = '') -> ProcessSpec:
        body = f'<node pkg="demo" exec="talker" {attributes}>{children}</node>'
        return expand(body).processes[0]

    return expand_node


def environments(plan: Plan) -> list[dict[str, str]]:
    return [process.environment for process in plan.processes]


NODE = '<node pkg="demo" exec="talker"/>'


def test_arguments_have_defaults_that_the_command_line_overrides(expand):
    body = '<arg name="a" default="1"/><arg name="b" default="$(var a)2"/>'
    body += f'<set_env name="B" value="$(var b)"/>{NODE}'

    def found(**arguments: str) -> str:
        return environments(expand(body, **arguments))[0]['B']

    assert (found(), found(a='3'), found(b='x')) == ('12', '32', 'x')


def test_required_argument_is_named_with_its_description(expand):
    with pytest.raises(CommandError, match=r"'plan' \(the table\) was not.*'plan:=<value>'"):
        expand('<arg name="plan" description="the table"/>')


def test_conditions(expand):
    body = (
        '<arg name="on" default="true"/><node if="$(var on)" pkg="demo" exec="talker" name="a"/>'
    )
    body += '<node unless="$(var on)" pkg="demo" exec="talker" name="b"/>'

    def names(**arguments: str) -> list[str]:
        return [process.command[-1] for process in expand(body, **arguments).processes]

    assert names() == ['__node:=a']
    assert names(on='0') == ['__node:=b']
    with pytest.raises(CommandError, match=r"<node> if: 'maybe' is no condition"):
        expand(body, on='maybe')


def test_group_keeps_its_variables_to_itself(expand):
    body = f'<set_env name="E" value="out"/><group><set_env name="E" value="in"/>{NODE}</group>'
    found = environments(expand(body + NODE))
    assert found == [{'HOME': '/home/me', 'E': 'in'}, {'HOME': '/home/me', 'E': 'out'}]


def test_include_passes_arguments_and_shares_its_scope(expand, prefix):
    prefix.add_launch_file(
        '<arg name="a"/><arg name="b" default="$(var a)!"/>', 'inner.launch.xml'
    )
    body = '<include file="$(dirname)/inner.launch.xml"><arg name="a" value="hi"/></include>'
    body += f'<set_env name="B" value="$(var b)"/>{NODE}'
    assert environments(expand(body))[0]['B'] == 'hi!'


def test_include_of_a_missing_file_or_of_itself(expand):
    with pytest.raises(CommandError, match=r"<include>: launch file '/no/x.xml' does not exist"):
        expand('<include file="/no/x.xml"/>')
    with pytest.raises(CommandError, match='includes itself'):
        expand('<include file="$(dirname)/demo.launch.xml"/>')


def test_processes_are_numbered_through(expand):
    names = [process.name for process in expand(NODE + NODE).processes]
    assert names == ['talker-1', 'talker-2']


def test_node_command_is_that_of_the_launch_library(node, prefix):
    # Read off the processes that launch_ros 0.26.6 starts for the same elements.
    spec = node(
        'name="n" namespace="ns"',
        '<remap from="a" to="b"/><remap from="c" to="$(dirname)"/>',
    )
    assert spec.command == (
        f'{prefix.root}/lib/demo/talker', '--ros-args', '-r', '__node:=n', '-r', '__ns:=/ns',
        '-r', 'a:=b', '-r', f'c:={prefix.share}',
    )  # fmt: skip


@pytest.mark.parametrize(
    ('pushed', 'own', 'expected'),
    [
        ([], None, None),
        ([], 'b', '/b'),
        (['a'], None, '/a'),
        (['a'], 'b', '/a/b'),
        (['a', 'b'], None, '/a/b'),
        (['a'], '/b', '/b'),
        (['a', '/b/'], None, '/b'),
    ],
)
def test_namespaces_add_up(pushed, own, expected, expand):
    body = ''.join(f'<push_ros_namespace namespace="{name}"/>' for name in pushed)
    attribute = f'namespace="{own}"' if own else ''
    body += f'<node pkg="demo" exec="talker" {attribute}/>'
    command = expand(f'<group>{body}</group><node pkg="demo" exec="talker"/>').processes[0].command
    assert ([word for word in command if word.startswith('__ns:=')] or [None])[0] == (
        expected and f'__ns:={expected}'
    )


def test_namespace_ends_with_its_group(expand):
    body = '<group><push-ros-namespace namespace="a"/></group><node pkg="demo" exec="talker"/>'
    assert expand(body).processes[0].command[1:] == ('--ros-args',)


def test_parameters_travel_in_files_in_their_order(node, tmp_path):
    (tmp_path / 'given.yaml').write_text('/**: {ros__parameters: {a: 1}}')
    children = f'<param from="{tmp_path}/given.yaml"/><param name="leg.phase" value="0.5"/>'
    words = node('', children).command[2:]
    assert words[0::2] == ('--params-file', '--params-file')
    assert words[1] == f'{tmp_path}/given.yaml'
    content = yaml.safe_load(Path(words[3]).read_text())
    assert content == {'/**': {'ros__parameters': {'leg.phase': 0.5}}}


def test_parameters_of_a_node_whose_name_is_known_are_for_it_alone(node):
    words = node('name="n" namespace="ns"', '<param name="a" value="1"/>').command
    content = yaml.safe_load(Path(words[-1]).read_text())
    assert content == {'/ns/n': {'ros__parameters': {'a': 1}}}


@pytest.mark.parametrize(
    ('children', 'message'),
    [
        ('<param from="/no/file.yaml"/>', "parameter file '/no/file.yaml' does not exist"),
        ('<param name="a"/>', "<param> needs 'name' and 'value', or 'from'"),
        ('<param from="x" name="a"/>', "<param> has 'from', expected no name"),
        ('<param name="a" value="[1, x]"/>', 'no list of one type'),
        ('<param name="a" value="x" type="real"/>', "type 'real' is unknown, expected yaml, str"),
    ],
)
def test_parameter_errors(children: str, message: str, node):
    with pytest.raises(CommandError, match=message):
        node('', children)


def test_process_settings(node):
    spec = node('output="screen" on_exit="shutdown"')
    assert (spec.output, spec.shutdown_on_exit) == ('screen', True)


@pytest.mark.parametrize(
    ('attributes', 'message'),
    [
        ('output="file"', "output 'file'; supported: screen, log, both"),
        ('on_exit="restart"', "on_exit 'restart'; supported: shutdown"),
        ('namespace="$(var nope)"', "<node>: launch configuration 'nope' does not exist"),
    ],
)
def test_setting_errors(attributes: str, message: str, node):
    with pytest.raises(CommandError, match=message):
        node(attributes)


def test_missing_package_and_executable(expand):
    with pytest.raises(CommandError, match="<node>: Package 'none' not found"):
        expand('<node pkg="none" exec="x"/>')
    with pytest.raises(CommandError, match="package 'demo' has no 'x'; it has: talker"):
        expand('<node pkg="demo" exec="x"/>')
