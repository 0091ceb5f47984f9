# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 param dump`: the parameters of a node as a file that `--params-file` takes."""

import argparse
from typing import Any

import yaml

from ros2_mini import calls
from ros2_mini.calls import find_node
from ros2_mini.node_context import open_node
from ros2_mini.parameters import get_parameters, list_parameters, python_value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 param dump`."""
    calls.add_arguments(parser)
    parser.add_argument('node_name', help='Name of the ROS node')


def main(args: argparse.Namespace) -> int:
    """Print the parameters as YAML."""
    with open_node() as node:
        target = find_node(node, args.node_name, args)
        names = list_parameters(node, target)
        values = get_parameters(node, target, names)
    tree = nested({name: python_value(value) for name, value in zip(names, values, strict=True)})
    print(yaml.dump({target: {'ros__parameters': tree}}, default_flow_style=False))
    return 0


def nested(parameters: dict[str, Any]) -> dict[str, Any]:
    """Return parameters with a mapping for each part of their names that a dot ends."""
    tree: dict[str, Any] = {}
    for name, value in parameters.items():
        *parts, last = name.split('.')
        branch = tree
        for part in parts:
            branch = branch.setdefault(part, {})
        branch[last] = value
    return tree
