# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Turn a `<node>` or `<executable>` element into the process it asks for."""

import os
import shlex
from collections.abc import Callable
from pathlib import Path

from ros2_mini.errors import CommandError
from ros2_mini.launch.document import Element
from ros2_mini.launch.parameters import parameter_arguments
from ros2_mini.launch.plan import ProcessSpec
from ros2_mini.launch.scope import Scope, template_of
from ros2_mini.packages import executable_path

OUTPUTS = ('screen', 'log', 'both')


def node_process(scope: Scope, node: Element, number: int) -> ProcessSpec:
    """Return the process of a `<node>`, the `number`-th of the launch."""
    try:
        path = executable_path(scope.text(node, 'pkg'), scope.text(node, 'exec'))
    except CommandError as error:
        raise CommandError(f'{node.where}: {error}') from error
    ros_args = words(scope, node, 'ros_args')
    command = [
        str(path),
        *words(scope, node, 'args'),
        *(['--ros-args', *ros_args] if ros_args else []),
        '--ros-args',
        *_names(scope, node),
        *(argument for remap in node.nested('remap') for argument in _remap(scope, remap)),
    ]
    name = scope.text(node, 'exec_name', path.name)
    return _process(scope, node, f'{name}-{number}', command)


def executable_process(scope: Scope, executable: Element, number: int) -> ProcessSpec:
    """Return the process of an `<executable>`, the `number`-th of the launch."""
    command = words(scope, executable, 'cmd')
    if not command:
        raise CommandError(f"{executable.where} has an empty 'cmd'")
    name = scope.text(executable, 'name', Path(command[0]).name)
    return _process(scope, executable, f'{name}-{number}', command)


def prefixed(base: str | None, namespace: str | None) -> str | None:
    """Return the absolute namespace that `namespace` means inside `base`; None for neither."""
    if namespace is None:
        return base
    if not namespace.startswith('/'):
        namespace = f'{(base or "").rstrip("/")}/{namespace}'
    return namespace.rstrip('/') or '/'


def _names(scope: Scope, node: Element) -> list[str]:
    """Return the arguments that set a node's name, namespace and parameters."""
    name = scope.text(node, 'name', None)
    namespace = prefixed(scope.namespace, scope.text(node, 'namespace', None))
    arguments = []
    if name is not None:
        arguments += ['-r', f'__node:={name}']
    if namespace is not None:
        arguments += ['-r', f'__ns:={namespace}']
    known = name is not None and namespace is not None
    full_name = f'{(namespace or "").rstrip("/")}/{name}' if known else '/**'
    return arguments + parameter_arguments(scope, node, full_name)


def _remap(scope: Scope, remap: Element) -> list[str]:
    return ['-r', f'{scope.text(remap, "from")}:={scope.text(remap, "to")}']


def _process(scope: Scope, element: Element, name: str, command: list[str]) -> ProcessSpec:
    """Return the process with everything that nodes and executables have in common."""
    environment = dict(scope.environment)
    for variable in element.nested('env'):
        environment[scope.text(variable, 'name')] = scope.text(variable, 'value')
    return ProcessSpec(
        name=name,
        command=(*shlex.split(scope.text(element, 'launch-prefix')), *command),
        environment=environment,
        cwd=scope.text(element, 'cwd', None),
        shell=scope.flag(element, 'shell', False),
        output=_output(scope, element),
        shutdown_on_exit=_shutdown_on_exit(scope, element),
        respawn=scope.flag(element, 'respawn', False),
        respawn_delay=scope.number(element, 'respawn_delay', 0.0),
        respawn_max_retries=int(scope.number(element, 'respawn_max_retries', -1)),
        sigterm_timeout=scope.number(element, 'sigterm_timeout', 5.0),
        sigkill_timeout=scope.number(element, 'sigkill_timeout', 5.0),
    )


def _output(scope: Scope, element: Element) -> str:
    default = scope.text(element, 'output', 'log')
    output = os.environ.get('OVERRIDE_LAUNCH_PROCESS_OUTPUT', default)
    if output not in OUTPUTS:
        raise CommandError(
            f"{element.where} has output '{output}'; supported: {', '.join(OUTPUTS)}"
        )
    return output


def _shutdown_on_exit(scope: Scope, element: Element) -> bool:
    on_exit = scope.text(element, 'on_exit', None)
    if on_exit not in (None, 'shutdown'):
        raise CommandError(f"{element.where} has on_exit '{on_exit}'; supported: shutdown")
    return on_exit == 'shutdown'


def words(scope: Scope, element: Element, name: str) -> list[str]:
    """Return the words of an attribute.

    Literal text is split as a shell splits it. What a substitution stands for is never split: it
    joins the text that touches it, so `--file $(var path)` is two words whatever the path.
    """
    if name not in element.attributes:
        return []
    result: list[str] = []
    joins = False  # whether the next piece continues the last word
    for piece in template_of(element, name):
        if isinstance(piece, str):
            tokens = _split(piece, lambda: f'{element.where} {name}')
            _append(result, tokens, joins and not piece[0].isspace())
            joins = bool(tokens) and not piece[-1].isspace()
        else:
            _append(result, [scope.evaluate(element, (piece,))], joins)
            joins = True
    return result


def _append(result: list[str], tokens: list[str], joins: bool) -> None:
    if joins and tokens:
        result[-1] += tokens.pop(0)
    result += tokens


def _split(text: str, where: Callable[[], str]) -> list[str]:
    try:
        return shlex.split(text)
    except ValueError as error:
        raise CommandError(f"{where()}: '{text}': {error}") from error
