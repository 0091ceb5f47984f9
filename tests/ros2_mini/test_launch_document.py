# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import pytest
from ros2_mini.errors import CommandError
from ros2_mini.launch.document import ACTIONS, NESTED, RULES, read_launch_file


def test_elements_know_their_line(prefix):
    root = read_launch_file(prefix.add_launch_file('<group>\n<arg name="x"/>\n</group>'))
    (group,) = root.children
    (arg,) = group.nested('arg')
    assert (arg.line, arg.attributes) == (3, {'name': 'x'})
    assert arg.where.endswith('demo.launch.xml:3: <arg>')


@pytest.mark.parametrize('tag', ACTIONS)
def test_every_action_takes_a_condition(tag: str, prefix):
    attributes = ' '.join(f'{name}="1"' for name in RULES[tag].needs)
    path = prefix.add_launch_file(f'<{tag} {attributes} if="true"/>')
    assert read_launch_file(path).children[0].attributes['if'] == 'true'


@pytest.mark.parametrize(('parent', 'child'), NESTED)
def test_nested_tags_take_none(parent: str, child: str, prefix):
    outer = ' '.join(f'{name}="1"' for name in RULES[parent].needs)
    inner = ' '.join(f'{name}="1"' for name in NESTED[parent, child].needs)
    body = '<{0} {1}><{2} {3} {4}/></{0}>'
    read_launch_file(prefix.add_launch_file(body.format(parent, outer, child, inner, '')))
    with pytest.raises(CommandError, match=f"<{child}> has an attribute 'if'"):
        read_launch_file(
            prefix.add_launch_file(body.format(parent, outer, child, inner, 'if="1"'))
        )


@pytest.mark.parametrize(
    ('body', 'message'),
    [
        ('<nod/>', r':2: <nod> is not supported in <launch>; supported: arg, group, include'),
        ('<arg name="a"><node/></arg>', r'<node> is not supported in <arg>; supported: nothing'),
        (
            '<arg name="a" value="1"/>',
            r"<arg> has an attribute 'value' that is not supported; supported: default, desc",
        ),
        ('<node pkg="demo"/>', r"<node> needs the attribute 'exec'"),
        ('<group if="1" unless="0"/>', r"<group> has both 'if' and 'unless', expected one"),
        ('<group>', r':3: not a launch file in XML, the only format supported: mismatched tag'),
    ],
)
def test_error_names_file_line_and_tag(body: str, message: str, prefix):
    with pytest.raises(CommandError, match=r'demo\.launch\.xml' + f'.*{message}'):
        read_launch_file(prefix.add_launch_file(body))


def test_root_must_be_launch(tmp_path):
    path = tmp_path / 'x.launch.xml'
    path.write_text('<robot/>')
    with pytest.raises(CommandError, match='<robot> is the root, expected <launch>'):
        read_launch_file(path)
    with pytest.raises(CommandError, match=r"cannot read launch file '.*none.xml'"):
        read_launch_file(tmp_path / 'none.xml')
