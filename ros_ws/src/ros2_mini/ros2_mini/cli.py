# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The command line: which commands and verbs there are, and what their outcomes exit with.

A command is a module of `ros2_mini.verbs` whose table `VERBS` has for each verb what declares its
arguments and what runs it. Only the one that is asked for gets imported, so that `ros2 pkg prefix`
does not wait for rclpy.
"""

import argparse
import importlib
import os
import signal
import sys
from collections.abc import Sequence

from hexapod_node.environment import EnvironmentVariableError

from ros2_mini.errors import CommandError

VERBS: dict[str, dict[str, str]] = {
    'bag': {
        'info': 'Print information about a bag to the screen',
        'play': 'Play back ROS data from a bag',
    },
    'lifecycle': {
        'get': 'Get lifecycle state for one or more nodes',
        'list': 'Output a list of available transitions',
        'set': 'Trigger lifecycle state transition',
    },
    'node': {
        'info': 'Output information about a node',
        'list': 'Output a list of available nodes',
    },
    'param': {
        'describe': 'Show descriptive information about declared parameters',
        'get': 'Get parameter',
        'set': 'Set parameter',
    },
    'pkg': {'prefix': 'Output the prefix path of a package'},
    'topic': {
        'echo': 'Output messages from a topic',
        'list': 'Output a list of available topics',
    },
}
COMMANDS: dict[str, str] = {
    'launch': 'Run a launch file',
    'run': 'Run a package specific executable',
}


def _use(parser: argparse.ArgumentParser, command: str, verb: str) -> None:
    """Let `parser` take the arguments of a verb, or of a command without verbs, and call it."""
    module = importlib.import_module(f'ros2_mini.verbs.{command}')
    add_arguments, main = module.VERBS[verb]
    add_arguments(parser)
    parser.set_defaults(main=main)


def build_parser(argv: Sequence[str]) -> argparse.ArgumentParser:
    """Return the parser of the whole command line, complete only for the verb in `argv`."""
    words = [*[word for word in argv if not word.startswith('-')][:2], '', '']
    parser = argparse.ArgumentParser(
        prog='ros2', description='ros2 is an extensible command-line tool for ROS 2.'
    )
    parser.set_defaults(main=None, help_of=parser)
    commands = parser.add_subparsers(
        title='Commands', metavar='Call `ros2 <command> -h` for more detailed usage.'
    )
    for command, text in COMMANDS.items():
        command_parser = commands.add_parser(command, help=text)
        if command == words[0]:
            _use(command_parser, command, '')
    for command, verbs in VERBS.items():
        text = f'Various {command} related sub-commands'
        command_parser = commands.add_parser(command, help=text, description=text)
        command_parser.set_defaults(help_of=command_parser)
        verb_parsers = command_parser.add_subparsers(
            title='Commands',
            metavar=f'Call `ros2 {command} <command> -h` for more detailed usage.',
        )
        for verb, verb_text in verbs.items():
            verb_parser = verb_parsers.add_parser(verb, help=verb_text, description=verb_text)
            if [command, verb] == words[:2]:
                _use(verb_parser, command, verb)
    return parser


def _call(args: argparse.Namespace) -> int:
    """Run the chosen verb and turn what stopped it into an exit status."""
    try:
        return args.main(args)
    except KeyboardInterrupt:
        return signal.SIGINT
    except BrokenPipeError:
        # The reader has gone (`ros2 topic echo ... | head`): leave without a second complaint.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except (CommandError, EnvironmentVariableError) as error:
        print(error, file=sys.stderr)
        return 1


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command line.

    Args:
        argv: The words after `ros2`; those of the process when None.

    Returns:
        The exit status: 0, 1 for a request that could not be met, or the number of the signal
        that ended a verb which runs until it is interrupted.
    """
    words = sys.argv[1:] if argv is None else list(argv)
    if hasattr(sys.stdout, 'reconfigure'):
        # What a terminal's encoding lacks is written as an escape.
        sys.stdout.reconfigure(line_buffering=True, errors='backslashreplace')
    args = build_parser(words).parse_args(words)
    if args.main is None:
        args.help_of.print_help()
        return 0
    return _call(args)
