# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ask lifecycle nodes for their state and transitions, and trigger one."""

from lifecycle_msgs.msg import State, Transition, TransitionDescription
from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState
from rclpy.node import Node

from ros2_mini.calls import call
from ros2_mini.names import node_names


def lifecycle_nodes(node: Node, *, hidden: bool = False) -> list[str]:
    """Return the names of the lifecycle nodes in the graph, sorted."""
    services = dict(node.get_service_names_and_types())
    return [
        name
        for name in node_names(node, hidden=hidden)
        if 'lifecycle_msgs/srv/GetState' in services.get(f'{name}/get_state', [])
    ]


def get_state(node: Node, target: str) -> State:
    """Return the state of a node."""
    return call(node, GetState, f'{target}/get_state', GetState.Request()).current_state


def get_transitions(
    node: Node, target: str, *, everything: bool = False
) -> list[TransitionDescription]:
    """Return the transitions that a node can make now, or all that it knows."""
    service = 'get_transition_graph' if everything else 'get_available_transitions'
    request = GetAvailableTransitions.Request()
    return call(
        node, GetAvailableTransitions, f'{target}/{service}', request
    ).available_transitions


def change_state(node: Node, target: str, transition: Transition) -> bool:
    """Trigger a transition; return whether it succeeded."""
    request = ChangeState.Request(transition=transition)
    return call(node, ChangeState, f'{target}/change_state', request).success
