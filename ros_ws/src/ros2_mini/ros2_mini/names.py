# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Names in the graph: which are hidden, and what a short one stands for."""

from rclpy.node import HIDDEN_NODE_PREFIX, Node


def is_hidden(name: str) -> bool:
    """Say whether any part of a name starts with an underscore."""
    return any(part.startswith(HIDDEN_NODE_PREFIX) for part in name.split('/'))


def node_names(node: Node, *, hidden: bool = False) -> list[str]:
    """Return the fully qualified names of the nodes in the graph, sorted, duplicates included."""
    return sorted(
        f'{namespace.rstrip("/")}/{name}'
        for name, namespace in node.get_node_names_and_namespaces()
        if hidden or not is_hidden(name)
    )
