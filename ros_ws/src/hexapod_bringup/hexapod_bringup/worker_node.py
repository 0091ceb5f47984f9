# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A whole worker in one process: sim, cpg, agent and recorder, served by one executor."""

from collections.abc import Sequence

from hexapod_node.lifeline import follow
from hexapod_node.shared_memory import free_abandoned
from hexapod_node.spin import run
from rclpy.node import Node


def make_worker() -> list[Node]:
    """Make the nodes of a worker; they are wired by topics, as separate processes are.

    Their libraries take seconds to load, and only from here on does a signal end the process in
    order.
    """
    from hexapod_agent.nodes.agent_node import AgentNode
    from hexapod_cpg.nodes.cpg_node import CpgNode
    from hexapod_doe.nodes.recorder_node import RecorderNode
    from hexapod_sim.nodes.sim_node import SimNode

    return [SimNode(), CpgNode(), RecorderNode(), AgentNode()]


def main(args: Sequence[str] | None = None) -> None:
    """Run the worker until a signal comes, or the manager that started it ends."""
    follow()
    free_abandoned()
    run(make_worker, args)
