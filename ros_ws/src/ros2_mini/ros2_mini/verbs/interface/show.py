# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 interface show`: the definition of a type, those of its fields indented below them."""

import argparse
import sys
from collections.abc import Iterator

from rosidl_adapter.parser import MessageSpecification, parse_message_string

from ros2_mini.interfaces import definition_path

_SEPARATOR = '---'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 interface show`."""
    comments = parser.add_mutually_exclusive_group()
    comments.add_argument(
        '--all-comments', action='store_true',
        help='Show all comments, including for nested interface definitions',
    )  # fmt: skip
    comments.add_argument(
        '--no-comments', action='store_true', help='Show no comments or whitespace'
    )
    parser.add_argument(
        'type', help="Type (e.g. 'std_msgs/msg/String'); '-' reads it from standard input"
    )


def main(args: argparse.Namespace) -> int:
    """Print the definition."""
    name = sys.stdin.readline().strip() if args.type == '-' else args.type
    for line in definition(name, comments=not args.no_comments, nested=args.all_comments):
        print(line)
    return 0


def definition(name: str, *, comments: bool, nested: bool, depth: int = 0) -> Iterator[str]:
    """Yield the lines of a definition.

    Args:
        name: Such as `std_msgs/msg/String`.
        comments: Whether to keep comments and empty lines.
        nested: Whether to keep them in the definitions of fields.
        depth: How far to indent [tabs].
    """
    package, _, interface = name.split('/') if name.count('/') == 2 else ('', '', '')
    for line in definition_path(name).read_text(encoding='utf-8').splitlines():
        text = line.rstrip()
        if text == _SEPARATOR:
            yield '\t' * depth + text
            continue
        spec = parse_message_string(package, interface, text)
        shown = text if comments else _without_comment(text, spec)
        if shown:
            yield '\t' * depth + shown
        elif comments:
            yield ''
        if field_type := _nested_type(spec):
            yield from definition(field_type, comments=nested, nested=nested, depth=depth + 1)


def _without_comment(text: str, spec: MessageSpecification) -> str:
    """Return a line less its comment, as the original cuts it.

    A field keeps a `#` that a blank parts from the comment, and a constant keeps the comment.
    """
    if spec.annotations['comment']:
        return ''
    comments = spec.fields[0].annotations['comment'] if spec.fields else []
    return text[: text.find(comments[0]) - 1].strip() if comments else text


def _nested_type(spec: MessageSpecification) -> str | None:
    """Return the type of the line's field if that is a message, else None."""
    if not spec.fields or spec.fields[0].type.is_primitive_type():
        return None
    kind = spec.fields[0].type
    return f'{kind.pkg_name}/msg/{kind.type}'
