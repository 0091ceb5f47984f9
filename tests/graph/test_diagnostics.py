# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Every node that stays on the graph says once a second how it is."""

from collections import defaultdict
from itertools import pairwise
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_bringup.description_node import DescriptionNode
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_doe.nodes.player_node import PlayerNode
from hexapod_doe.nodes.recorder_node import RecorderNode
from hexapod_node.stamps import to_nanoseconds
from hexapod_sim.nodes.fake_driver_node import FakeDriverNode
from hexapod_sim.nodes.sim_node import SimNode
from rclpy.parameter import Parameter

pytestmark = pytest.mark.graph
SAMPLE = Path(__file__).resolve().parents[2] / 'bags' / 'sample'


def test_all_nodes_report(graph) -> None:
    reports: dict[str, list[int]] = defaultdict(list)

    def note(message: DiagnosticArray) -> None:
        (status,) = message.status
        reports[status.name].append(to_nanoseconds(message.header.stamp))

    graph.nodes[0].create_subscription(DiagnosticArray, '/diagnostics', note, 100)
    player = PlayerNode([Parameter('bag', value=str(SAMPLE)), Parameter('paused', value=True)])
    nodes = [SimNode(), CpgNode(), AgentNode(), RecorderNode(), player]
    graph.add(*nodes, FakeDriverNode(), DescriptionNode())
    names = {f'/{node.get_name()}: state' for node in graph.nodes[1:]}
    assert len(names) == 7
    graph.until(lambda: names <= {name for name, at in reports.items() if len(at) > 2})
    for name in names:
        # Once a second; a busy machine is late, not lax.
        gaps = [(after - before) * 1e-9 for before, after in pairwise(reports[name])]
        assert min(gaps) > 0.3
        assert min(gaps) < 1.5
