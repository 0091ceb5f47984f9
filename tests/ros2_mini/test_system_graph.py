# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The verbs that look at a graph, against a live node; texts as ros2cli 0.32.2 prints them."""

import contextlib
import importlib

import pytest
from ros2_mini import discovery, node_calls
from ros2_mini.cli import VERBS, main
from ros2_mini.node_context import open_node

pytestmark = [pytest.mark.graph, pytest.mark.system, pytest.mark.usefixtures('sample')]


@pytest.fixture(scope='module')
def connected(sample):
    """A node that knows the graph."""
    with open_node() as node:
        discovery.wait_until_settled(node, discovery.DEFAULT_LIMIT)
        yield node


@pytest.fixture
def shared(connected, monkeypatch):
    """Let every verb work through one node: what to find is known already."""
    modules = [importlib.import_module(f'ros2_mini.verbs.{command}') for command in VERBS]
    for module in (node_calls, *modules):
        for name in ('open_node', 'graph_node'):
            if hasattr(module, name):
                use = lambda *_, **__: contextlib.nullcontext(connected)  # noqa: E731
                monkeypatch.setattr(module, name, use)


INFO = """/sample
  Subscribers:
    /listen: std_msgs/msg/String
  Publishers:
    /chatter: std_msgs/msg/String
    /joint_states: sensor_msgs/msg/JointState
    /parameter_events: rcl_interfaces/msg/ParameterEvent
    /rosout: rcl_interfaces/msg/Log
    /sample/transition_event: lifecycle_msgs/msg/TransitionEvent
    /status: std_msgs/msg/String
  Service Servers:
    /sample/change_state: lifecycle_msgs/srv/ChangeState
"""
TOPICS = """/chatter [std_msgs/msg/String]
/joint_states [sensor_msgs/msg/JointState]
/listen [std_msgs/msg/String]
/parameter_events [rcl_interfaces/msg/ParameterEvent]
/rosout [rcl_interfaces/msg/Log]
/sample/transition_event [lifecycle_msgs/msg/TransitionEvent]
/status [std_msgs/msg/String]
"""


@pytest.mark.usefixtures('shared')
def test_nodes(output, error):
    assert output('node', 'list', '-c') == '1\n'
    found = output('node', 'info', '/sample')
    assert found.startswith(INFO)
    assert found.endswith('  Action Servers:\n    /train: hexapod_interfaces/action/TrainRun\n'
                          '  Action Clients:\n\n')  # fmt: skip
    assert error('node', 'info', '/nope') == "Unable to find node '/nope'\n"


@pytest.mark.usefixtures('shared')
def test_topics(output):
    assert output('topic', 'list', '-t') == TOPICS
    assert output('topic', 'list', '-c') == '7\n'
    found = output('topic', 'list', '-v')
    assert 'Published topics:\n * /chatter [std_msgs/msg/String] 1 publisher\n' in found
    assert found.endswith('Subscribed topics:\n * /listen [std_msgs/msg/String] 1 subscriber\n\n')


@pytest.mark.parametrize(
    ('name', 'expected'),
    [
        ('label', 'String value is: plain\n'),
        ('count', 'Integer value is: 7\n'),
        ('weights', 'Double values are: [0.5, 1.5]\n'),
        ('fixed', 'Boolean value is: True\n'),
    ],
)
@pytest.mark.usefixtures('shared')
def test_parameter_values(name, expected, output):
    assert output('param', 'get', '/sample', name) == expected


@pytest.mark.usefixtures('shared')
def test_parameters_can_be_set_within_their_limits(output, capsys):
    assert output('param', 'set', '/sample', 'rate', '3.5') == 'Set parameter successful\n'
    assert output('param', 'get', 'sample', 'rate', '--hide-type') == '3.5\n'
    assert main(['param', 'set', '/sample', 'rate', '99.0']) == 0
    assert capsys.readouterr().err.startswith('Setting parameter failed: ')


DESCRIBED = """Parameter name: rate
  Type: double
  Description: Pace of nothing [Hz]
  Constraints:
    Min value: 0.5
    Max value: 9.0
Parameter name: fixed
  Type: boolean
  Constraints:
    Read only: true
"""


@pytest.mark.usefixtures('shared')
def test_parameters_are_described(output, error):
    assert output('param', 'describe', '/sample', 'rate', 'fixed') == DESCRIBED
    missing = ('param', 'get', '/nope', 'x', '--spin-time', '0.1')
    assert error(*missing) == "Node not found: '/nope'\n"
    assert error('param', 'get', '/sample', 'x') == "Parameter not set: 'x' of '/sample'\n"


@pytest.mark.usefixtures('shared')
def test_lifecycle(output, error):
    assert output('lifecycle', 'get') == '/sample: unconfigured [1]\n'
    assert output('lifecycle', 'set', '/sample', 'configure') == 'Transitioning successful\n'
    assert output('lifecycle', 'get', '/sample') == 'inactive [2]\n'
    first = '- cleanup [2]\n\tStart: inactive\n\tGoal: cleaningup\n'
    assert output('lifecycle', 'list', '/sample').startswith(first)
    message = error('lifecycle', 'set', '/sample', 'configure')
    assert message.startswith("Unknown transition 'configure' requested, available ones are: cl")
