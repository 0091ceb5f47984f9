# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""An evaluation on the graph ends with one line where a part of the graph is absent."""

from __future__ import annotations

import pytest
from hexapod_agent.environment.evaluation import GraphError
from hexapod_agent.nodes.evaluate_node import EvaluationNode
from hexapod_interfaces.action import TrainRun
from hexapod_node.coroutines import start
from hexapod_sim.nodes.sim_node import SimNode

# A domain where no other test ever had an agent: rclpy leaves action servers behind.
pytestmark = [pytest.mark.graph, pytest.mark.usefixtures('own_domain')]


def test_without_an_agent_it_says_so(graph) -> None:
    sim = graph.add(SimNode())
    node = graph.add(EvaluationNode())
    with pytest.raises(GraphError, match=r'action /play_run: no server within 3 s'):
        graph.result(start(node.play(TrainRun.Goal(), sim, timeout_s=3.0)))
