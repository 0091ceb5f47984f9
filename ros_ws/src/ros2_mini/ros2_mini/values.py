# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Take the values of a message from the command line or from standard input."""

import argparse
import sys
from typing import Any

from ros2_mini.message_fill import read_values


def add_arguments(parser: argparse.ArgumentParser, name: str, text: str) -> None:
    """Declare the argument `name` with the help `text`, and its alternative `--stdin`."""
    source = parser.add_mutually_exclusive_group()
    source.add_argument('values', metavar=name, nargs='?', default='{}', help=text)
    source.add_argument('--stdin', action='store_true', help=f'Read {name} from standard input')


def given(args: argparse.Namespace) -> dict[str, Any]:
    """Return the fields that the command line or standard input gives.

    Raises:
        CommandError: If they are no YAML, or no mapping of field names.
    """
    return read_values(sys.stdin.read() if args.stdin else args.values)
