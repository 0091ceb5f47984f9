# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Writes tables of the documentation from running nodes and from the code's tables.

`python tests/support/interface_tables.py` replaces what stands between the markers of its pages;
a test holds them to it.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hexapod_agent.learning import checkpoint, metrics
from hexapod_agent.learning.training import Trainer
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_agent.nodes.play_node import PlayNode
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_bringup.description_node import DescriptionNode
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.designs.design import fraction
from hexapod_doe.designs.plan_file import write_plan
from hexapod_doe.designs.plan_table import make_plan
from hexapod_doe.nodes.manager_node import PARAMETERS as MANAGER_PARAMETERS
from hexapod_doe.nodes.manager_node import ManagerNode
from hexapod_doe.nodes.player_node import PlayerNode
from hexapod_doe.nodes.recorder_node import RecorderNode
from hexapod_doe.studies.study_text import replace_block
from hexapod_node.session import begin
from hexapod_node.sync import LOCKSTEP, REALTIME
from hexapod_sim.command_line import CommandLine
from hexapod_sim.nodes.fake_driver_node import FakeDriverNode
from hexapod_sim.nodes.sim_node import SimNode
from hexapod_sim.sensor_table import CHANNELS, LETTERS
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.action import get_action_server_names_and_types_by_node
from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy
from rclpy.utilities import try_shutdown
from specification_tables import specification_tables

SAMPLE_BAG = 'bags/sample'
PAGES = {
    'sensors': 'docs/sensors.md',
    'interfaces': 'docs/interfaces.md',
    'metrics': 'bags/README.md',
    'specification': 'docs/specification.md',
}
"""Where each table stands, below the root of the repository."""
_NODES = {
    'sim': (SimNode, 'hexapod_sim sim_node'),
    'cpg': (CpgNode, 'hexapod_cpg cpg_node'),
    'agent': (AgentNode, 'hexapod_agent agent_node'),
    'play': (PlayNode, 'hexapod_agent play_node'),
    'recorder': (RecorderNode, 'hexapod_doe recorder_node'),
    'player': (PlayerNode, 'hexapod_doe player_node'),
    'manager': (ManagerNode, 'hexapod_doe manager_node'),
    'fake_driver': (FakeDriverNode, 'hexapod_sim fake_driver'),
    'description': (DescriptionNode, 'hexapod_bringup description_node'),
}
# Nodes that have further topics in real time.
_TWO_FACED = ('cpg',)
# Parameters that the nodes were given here, and their defaults.
_GIVEN = {
    'manager': {
        p.name: str(p.default) for p in MANAGER_PARAMETERS if p.name in ('plan', 'local_workers')
    },
    'play': {'bag': '', 'checkpoint': '', 'sync': LOCKSTEP},
    'player': {'bag': ''},
}
_GREATEST_INTEGER = 2**63 - 1
# What every rclpy node has is not worth a row.
_COMMON_TOPICS = ('/rosout', '/parameter_events', '/diagnostics')
_COMMON_SERVICES = re.compile(r'/((describe|get|list|set)_parameter\w*|get_type_description)$')
_LIFECYCLE_SERVICES = re.compile(
    r'/(change_state|get_state|get_available_\w+|get_transition_graph)$'
)


def sensor_table() -> str:
    """Return the sensor table as Markdown."""
    rows = [
        (
            channel.letter or 'always',
            channel.name,
            str(channel.size),
            ', '.join(f'`{topic}`' for topic in channel.topics) or 'none',
            f'`{channel.message_type}`' if channel.message_type else 'none',
            ', '.join(quantity.unit for quantity in channel.quantities),
            ', '.join(f'{quantity.scale:g}' for quantity in channel.quantities),
            channel.device,
        )
        for channel in CHANNELS
    ]
    head = ('letter', 'channel', 'numbers', 'topic', 'type', 'unit', 'scale', 'device')
    return _markdown(head, rows)


def metric_table() -> str:
    """Return the table of the learner's metrics as Markdown."""
    rows = [(f'`{metric.name}`', metric.unit, metric.meaning) for metric in metrics.METRICS]
    return _markdown(('metric', 'unit', 'meaning'), rows)


def node_tables(bag: Path) -> str:
    """Return the tables of all nodes as Markdown. Uses rclpy's default context.

    Args:
        bag: Any bag, which the player node needs to start.
    """
    with TemporaryDirectory() as directory:
        plan = Path(directory) / 'plan.csv'
        write_plan(make_plan(fraction('eighth')), plan)
        # In real time the node `play` subscribes by itself: here to all that it ever does.
        agent = Path(directory) / 'agent.pt'
        trainer = Trainer(RunSpec.load().observing(LETTERS), 0)
        checkpoint.save_agent(agent, trainer)
        given = [f'plan:={plan}', 'local_workers:=0', f'bag:={bag}']
        given += [f'checkpoint:={agent}', f'play:sync:={REALTIME}']
        begin(['--ros-args', *(word for value in given for word in ('-p', value))])
        sections = []
        for name, (make, executable) in _NODES.items():
            further = _interface_in_real_time(make) if name in _TWO_FACED else []
            node = make()
            played = set(BagFile(bag).types) if name == 'player' else set()
            table = _node_table(node, played, further)
            sections.append(f'## `{name}`: `ros2 run {executable}`\n\n{table}')
            node.destroy_node()
        try_shutdown()
    return '\n\n'.join(sections)


def _interface_in_real_time(make: Callable[..., Node]) -> list[tuple[str, ...]]:
    node = make([Parameter('sync', value=REALTIME)])
    rows = list(_interface(node))
    node.destroy_node()
    return rows


def _node_table(node: Node, played: set[str], further: Iterable[tuple[str, ...]]) -> str:
    every = dict.fromkeys([*_interface(node), *further])
    rows = [row for row in every if f'/{row[1].strip("`")}' not in played]
    if played:
        rows.append(('publishes', 'every topic of the bag', 'as recorded', 'as recorded'))
    interface = _markdown(('', 'name', 'type', 'quality of service'), rows)
    parameters = list(_parameters(node))
    if not parameters:
        return interface
    head = ('parameter', 'default', 'unit', 'range', 'meaning')
    return f'{interface}\n\n{_markdown(head, parameters)}'


def _interface(node: Node) -> Iterator[tuple[str, ...]]:
    ends: list[tuple[str, str, Any, str, str]]
    ends = [('publishes', p.topic_name, p.msg_type, 'msg', _quality(p)) for p in node.publishers]
    ends += [
        ('subscribes', s.topic_name, s.msg_type, 'msg', _quality(s)) for s in node.subscriptions
    ]
    ends += [('serves', s.service_name, s.srv_type, 'srv', '') for s in node.services]
    ends += [('calls', c.service_name, c.srv_type, 'srv', '') for c in node.clients]
    for what, name, kind, interface, quality in ends:
        common = _COMMON_SERVICES.search(name) or _LIFECYCLE_SERVICES.search(name)
        if name not in _COMMON_TOPICS and not common:
            package = kind.__module__.split('.')[0]
            yield what, _code(name), f'`{package}/{interface}/{kind.__name__}`', quality
    if isinstance(node, LifecycleNode):
        transitions = 'the transitions of a managed node', '`lifecycle_msgs/srv/ChangeState`, …'
        yield 'serves', *transitions, ''
    own = (node.get_name(), node.get_namespace())
    for name, kinds in get_action_server_names_and_types_by_node(node, *own):
        yield 'action', _code(name), f'`{kinds[0]}`', ''


def _quality(end: Any) -> str:
    """Say which quality of service a publisher offers, or a subscription asks for."""
    qos = end.qos_profile
    reliable = 'reliable' if qos.reliability is ReliabilityPolicy.RELIABLE else 'best effort'
    latched = 'latched' if qos.durability is DurabilityPolicy.TRANSIENT_LOCAL else ''
    kept = f'last {qos.depth}' if qos.history is HistoryPolicy.KEEP_LAST else 'keeps all'
    return ', '.join(filter(None, (reliable, latched, kept)))


def _parameters(node: Node) -> Iterator[tuple[str, ...]]:
    for name in sorted(node.get_parameters_by_prefix('')):
        if name in ('use_sim_time', 'start_type_description_service'):
            continue
        described = node.describe_parameter(name)
        constraints = described.additional_constraints
        words = dict(part.split(': ', 1) for part in constraints.split('; ') if part)
        given = _GIVEN.get(node.get_name(), {})
        default = given.get(name, str(node.get_parameter(name).value))
        yield (
            f'`{name}`',
            f'`{default}`' if default else '',
            words.get('unit', ''),
            words.get('one of') or _range(described),
            described.description,
        )


def _range(described: ParameterDescriptor) -> str:
    for limits in (*described.floating_point_range, *described.integer_range):
        low, high = limits.from_value, limits.to_value
        return f'{low:.15g} or more' if high == _GREATEST_INTEGER else f'{low:.15g} to {high:.15g}'
    return ''


def _code(name: str) -> str:
    """Return a name as users write it: relative, so that a namespace can go before it."""
    return f'`{name.removeprefix("/")}`'


def _markdown(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ['---'] * len(head), *rows]
    return '\n'.join(f'| {" | ".join(line)} |' for line in lines)


def main(arguments: Sequence[str] | None = None) -> None:
    """Write all tables into their pages."""
    parser = CommandLine(description=__doc__)
    parser.add_argument('root', type=Path, nargs='?', default=Path(), help='of the repository')
    root = parser.parse_args(arguments).root
    tables = {
        'sensors': sensor_table(),
        'interfaces': node_tables(root.resolve() / SAMPLE_BAG),
        'metrics': metric_table(),
        'specification': specification_tables(),
    }
    for name, table in tables.items():
        page = root / PAGES[name]
        page.write_text(
            replace_block(page.read_text(encoding='utf-8'), name, table), encoding='utf-8'
        )


if __name__ == '__main__':
    main()
