# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 run`: become an executable of a package.

The original starts a child and waits; here the process is replaced, so that signals reach the
node itself and its exit status is the command's.
"""

import argparse
import os
import shlex

from ros2_mini.errors import CommandError
from ros2_mini.packages import executable_path


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        '--prefix',
        default='',
        help='Prefix command, which should go before the executable, in quotes if it contains '
        "spaces (e.g. --prefix 'gdb -ex run --args')",
    )
    parser.add_argument('package_name', help='Name of the ROS package')
    parser.add_argument('executable_name', help='Name of the executable')
    parser.add_argument(
        'argv', nargs=argparse.REMAINDER, help='Pass arbitrary arguments to the executable'
    )


def _run(args: argparse.Namespace) -> int:
    """Replace this process by the executable; return only if that is impossible."""
    path = executable_path(args.package_name, args.executable_name)
    command = [*shlex.split(args.prefix), str(path), *args.argv]
    try:
        os.execvp(command[0], command)
    except OSError as error:
        raise CommandError(f"cannot run '{command[0]}': {error.strerror}") from error


VERBS = {'': (_arguments, _run)}
