# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 interface list`: the installed message, service and action types."""

import argparse

from ros2_mini.interfaces import interface_names

_HEADINGS = {'msg': 'Messages', 'srv': 'Services', 'action': 'Actions'}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 interface list`."""
    for kind, option in (('msg', 'msgs'), ('srv', 'srvs'), ('action', 'actions')):
        parser.add_argument(
            f'-{kind[0]}', f'--only-{option}', action='append_const', dest='kinds', const=kind,
            help=f'Print out only the {_HEADINGS[kind].lower()}',
        )  # fmt: skip


def main(args: argparse.Namespace) -> int:
    """Print the types of the kinds asked for, or of all."""
    for kind, heading in _HEADINGS.items():
        if args.kinds is None or kind in args.kinds:
            print(f'{heading}:')
            for name in interface_names(kind):
                print(f'    {name}')
    return 0
