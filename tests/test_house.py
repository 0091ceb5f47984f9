# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Who may import what: dependencies run one way, and ROS stays in the folders of nodes."""

import ast
from collections import defaultdict
from collections.abc import Callable
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
# Each package and the ones of ours that it may import.
MAY_IMPORT = {
    'hexapod_sim': {'hexapod_sim'},
    'hexapod_cpg': {'hexapod_cpg', 'hexapod_sim'},
    'hexapod_agent': {'hexapod_agent', 'hexapod_cpg', 'hexapod_sim'},
    'hexapod_doe': {'hexapod_doe', 'hexapod_agent', 'hexapod_cpg', 'hexapod_sim'},
}
OURS = {*MAY_IMPORT, 'hexapod_bringup'}
FILES = [file for name in MAY_IMPORT for file in sorted((ROOT / name / name).rglob('*.py'))]
SHARED = [
    file
    for name in ('hexapod_node', 'hexapod_bringup')
    for file in sorted((ROOT / 'ros_ws' / 'src' / name / name).rglob('*.py'))
]
MESSAGE_PACKAGES = {
    'diagnostic_msgs', 'geometry_msgs', 'hexapod_interfaces', 'hexapod_node', 'nav_msgs',
    'rcl_interfaces', 'rosgraph_msgs', 'sensor_msgs', 'std_srvs', 'trajectory_msgs',
}  # fmt: skip


@cache
def tree_of(file: Path) -> ast.Module:
    """Return a file's syntax tree, which several rules look at."""
    return ast.parse(file.read_text(encoding='utf-8'))


def imported(file: Path) -> set[str]:
    """Return the top-level packages that a file imports when it runs, type checking apart."""
    found = set()
    for node in ast.walk(tree_of(file)):
        if isinstance(node, ast.Import):
            found |= {alias.name.split('.')[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.add(node.module.split('.')[0])
    return found - type_checking_only(tree_of(file))


def type_checking_only(tree: ast.Module) -> set[str]:
    """Return the packages imported under `if TYPE_CHECKING`."""
    guarded = [
        statement
        for node in tree.body
        if isinstance(node, ast.If) and getattr(node.test, 'id', '') == 'TYPE_CHECKING'
        for statement in node.body
    ]
    return {s.module.split('.')[0] for s in guarded if isinstance(s, ast.ImportFrom) and s.module}


def offenders(files: list[Path], follows: Callable[[Path], bool]) -> list[str]:
    """Return the names of the files that do not follow a rule."""
    return [str(file.relative_to(ROOT)) for file in files if not follows(file)]


def test_dependencies_run_one_way() -> None:
    def follows(file: Path) -> bool:
        return imported(file) & OURS <= MAY_IMPORT[file.relative_to(ROOT).parts[0]]

    assert offenders(FILES, follows) == []


def test_only_nodes_touch_ros() -> None:
    def follows(file: Path) -> bool:
        return 'nodes' in file.parts or not imported(file) & {'rclpy', *MESSAGE_PACKAGES}

    assert offenders(FILES, follows) == []


def test_the_environment_is_judged_before_rclpy_is_loaded() -> None:
    def follows(file: Path) -> bool:
        names = [
            node.module if isinstance(node, ast.ImportFrom) else node.names[0].name
            for node in tree_of(file).body
            if isinstance(node, ast.Import | ast.ImportFrom)
        ]
        packages = [str(dotted).split('.')[0] for dotted in names]
        return 'rclpy' not in packages or 'hexapod_node' in packages[: packages.index('rclpy')]

    assert offenders(FILES, follows) == []


def test_files_stay_readable() -> None:
    def follows(file: Path) -> bool:
        return len(file.read_text(encoding='utf-8').splitlines()) <= 300

    assert offenders(FILES, follows) == []


def test_no_node_has_a_timer_of_rclpy() -> None:
    """They stop for ever after a pause of the process (docs/upstream.md)."""

    def follows(file: Path) -> bool:
        text = file.read_text(encoding='utf-8')
        return 'create_timer(' not in text and 'create_rate(' not in text

    assert offenders([*FILES, *SHARED], follows) == []


def test_every_node_is_one_that_no_peer_can_end() -> None:
    """A handler that fails is an answer (`hexapod_node.handlers`)."""

    def follows(file: Path) -> bool:
        text = file.read_text(encoding='utf-8')
        if file.name == 'node.py' and 'hexapod_node' in file.parts:
            return True
        for node in ast.walk(tree_of(file)):
            bases = [ast.unparse(base) for base in getattr(node, 'bases', ())]
            if {'ActionServer', 'ActionClient'} & set(bases):
                return False
            if {'Node', 'LifecycleNode'} & set(bases) and not (
                bases[0] == 'Node' and 'from hexapod_node.node import Node\n' in text
            ):
                return False
        return 'from rclpy.action import ActionClient' not in text

    assert offenders([*FILES, *SHARED], follows) == []


# A room is a folder of a package, or a file at its root.
WITHOUT_CIRCLES = [ROOT / name / name for name in MAY_IMPORT] + [
    ROOT / 'ros_ws' / 'src' / name / name
    for name in ('hexapod_node', 'hexapod_bringup', 'ros2_mini')
]


@pytest.mark.parametrize('package', WITHOUT_CIRCLES, ids=lambda package: package.name)
def test_no_circle_among_modules_nor_among_rooms(package: Path) -> None:
    modules, rooms = defaultdict(set), defaultdict(set)
    for file in sorted(package.rglob('*.py')):
        here = file.relative_to(package.parent).with_suffix('').parts
        for there in own_imports(file, package):
            modules[here].add(there)
            if there[1:2] != here[1:2]:
                rooms[here[1:2]].add(there[1:2])
    for graph in (modules, rooms):
        TopologicalSorter(graph).prepare()  # raises CycleError, which names the circle


def own_imports(file: Path, package: Path) -> set[tuple[str, ...]]:
    """Return the modules of its own package that a file imports, for type checking included."""
    found = set()
    for node in ast.walk(tree_of(file)):
        if isinstance(node, ast.ImportFrom) and (node.module or '').startswith(package.name):
            dotted = tuple(str(node.module).split('.'))
            for alias in node.names:
                module = (*dotted, alias.name)
                is_module = package.parent.joinpath(*module).with_suffix('.py').is_file()
                found.add(module if is_module else dotted)
    return found - {(package.name,)}
