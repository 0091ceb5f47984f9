# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Names in the graph: which ones are hidden, and what a short one stands for."""

from rclpy.node import HIDDEN_NODE_PREFIX, Node


def is_hidden(name: str) -> bool:
    """Say whether any part of a name starts with an underscore."""
    return any(part.startswith(HIDDEN_NODE_PREFIX) for part in name.split('/'))


def absolute(name: str) -> str:
    """Return a name with a leading slash."""
    return name if name.startswith('/') else f'/{name}'


def full_name(name: str, namespace: str) -> str:
    """Return the fully qualified name of a node."""
    return f'{namespace.rstrip("/")}/{name}'


def split(full: str) -> tuple[str, str]:
    """Return the name and the namespace of a fully qualified node name."""
    namespace, _, name = full.rpartition('/')
    return name, namespace or '/'


def node_names(node: Node, *, hidden: bool = False) -> list[str]:
    """Return the fully qualified names of the nodes in the graph, sorted, duplicates included."""
    found = node.get_node_names_and_namespaces()
    return sorted(
        full_name(name, namespace)
        for name, namespace in found
        if hidden or not name.startswith(HIDDEN_NODE_PREFIX)
    )
