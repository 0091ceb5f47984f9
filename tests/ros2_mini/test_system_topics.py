# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The verbs that must find a live node by themselves, or exchange messages with it."""

import pytest
import rclpy
from hexapod_node.environment import domain_id
from hexapod_node.participants import participants_here
from ros2_mini.node_context import open_node

pytestmark = [pytest.mark.graph, pytest.mark.system, pytest.mark.usefixtures('sample')]


def test_node_list_sees_every_one_of_several_participants(output):
    contexts = [rclpy.Context() for _ in range(3)]
    nodes = []
    for number, context in enumerate(contexts):
        rclpy.init(context=context)
        nodes.append(rclpy.create_node(f'other_{number}', context=context))
    try:
        expected = '/other_0\n/other_1\n/other_2\n/sample\n'
        assert [output('node', 'list') for _ in range(3)] == [expected] * 3
    finally:
        for node, context in zip(nodes, contexts, strict=True):
            node.destroy_node()
            rclpy.shutdown(context=context)


def test_participants_of_this_host_are_counted():
    before = participants_here(domain_id())
    assert before >= 1  # the sample
    with open_node():
        assert participants_here(domain_id()) == before + 1


def test_echo(output, error):
    # The status was published before: only a matching durability brings it.
    assert output('topic', 'echo', '--once', '/status') == 'data: ready\n---\n'
    found = output('topic', 'echo', '--once', '/joint_states', '--field', 'position')
    assert found == "array('d', [0.5, -1.0])\n---\n"
    message = error('topic', 'echo', '--once', '/joint_states', '--field', 'positio')
    assert message.startswith("Invalid field 'positio': ")
    missing = ('topic', 'echo', '/nope', '--spin-time', '0.1')
    assert error(*missing) == 'Could not determine the type for the passed topic\n'
