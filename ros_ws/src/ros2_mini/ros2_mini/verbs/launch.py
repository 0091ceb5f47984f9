# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 launch`: start the processes of a launch file and end them together.

Unlike the original, the command fails if a process fails, SIGTERM ends the processes as SIGINT
does, and every error in a launch file is found before anything is started.
"""

import argparse
import asyncio
import os
import tempfile
from pathlib import Path

from hexapod_node.shared_memory import free_abandoned

from ros2_mini.errors import CommandError
from ros2_mini.launch.arguments import declarations, parse_launch_arguments
from ros2_mini.launch.expand import expand_launch_file
from ros2_mini.launch.log import LaunchLog, make_log_directory
from ros2_mini.launch.supervisor import Plan, Supervisor
from ros2_mini.packages import find_in_share


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        '-n', '--noninteractive', action='store_true', help='Accepted; it makes no difference here'
    )
    parser.add_argument(
        '-s', '--show-args', '--show-arguments', action='store_true',
        help='Show arguments that may be given to the launch file',
    )  # fmt: skip
    parser.add_argument(
        'package_name', help='Name of the ROS package which contains the launch file, or a file'
    )
    parser.add_argument('launch_file_name', nargs='?', help='Name of the launch file')
    parser.add_argument(
        'launch_arguments', nargs='*',
        help="Arguments to the launch file; '<name>:=<value>' (for duplicates, last one wins)",
    )  # fmt: skip


def _main(args: argparse.Namespace) -> int:
    """Run a launch file, or show its arguments."""
    path, words = _launch_file(args)
    if args.show_args:
        _show_arguments(path)
        return 0
    arguments = parse_launch_arguments(words)
    with tempfile.TemporaryDirectory(prefix='launch_') as parameter_directory:
        plan = expand_launch_file(path, arguments, os.environ, Path(parameter_directory))
        return _run(plan, sorted(arguments.keys() - plan.arguments))


def _launch_file(args: argparse.Namespace) -> tuple[Path, list[str]]:
    """Return the launch file and the words that follow it."""
    words = list(args.launch_arguments)
    if os.path.isfile(args.package_name):
        if args.launch_file_name is not None:
            words.insert(0, args.launch_file_name)
        return Path(args.package_name), words
    if args.launch_file_name is None:
        raise CommandError(f"launch file '{args.package_name}' does not exist")
    return find_in_share(args.package_name, args.launch_file_name), words


def _show_arguments(path: Path) -> None:
    found = declarations(path)
    print("Arguments (pass arguments as '<name>:=<value>'):")
    for declaration in found:
        print(f'\n{declaration}')
    if not found:
        print('\n  No arguments.')
    elif any(declaration.conditional for declaration in found):
        print('\n* argument(s) which are only used if specific conditions occur')


def _run(plan: Plan, undeclared: list[str]) -> int:
    free_abandoned()
    directory = make_log_directory()
    with LaunchLog(directory) as log:
        log.say('INFO', 'launch', f'All log files can be found below {directory}')
        log.say('INFO', 'launch', 'Default logging verbosity is set to INFO')
        for name in undeclared:
            log.say('WARNING', 'launch', f"no launch file declares the argument '{name}'")
        return asyncio.run(Supervisor(plan, log).run())


VERBS = {'': (_arguments, _main)}
