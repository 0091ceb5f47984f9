# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Split the `cmd`, `args` and `ros_args` of a launch file into words."""

import shlex
from collections.abc import Callable

from ros2_mini.errors import CommandError
from ros2_mini.launch.document import Element
from ros2_mini.launch.scope import Scope, template_of


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
