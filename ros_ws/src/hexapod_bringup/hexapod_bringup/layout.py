# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `layout`: how to see a run in Foxglove or in PlotJuggler, live or from a bag."""

from collections.abc import Sequence

from ament_index_python import get_package_share_path
from hexapod_sim.command_line import CommandLine, file

NAMESPACE = 'worker_1'
"""Namespace of the files that this package ships: that of worker.launch.xml."""
FILES = {'foxglove': 'foxglove.json', 'plotjuggler': 'plotjuggler.xml'}
"""What is shipped, by program."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Print a layout, or write it into a file."""
    parser = CommandLine(prog='layout', description=__doc__)
    parser.add_argument('program', choices=FILES)
    parser.add_argument(
        '--namespace', default=NAMESPACE, help=f'of the nodes to see (default {NAMESPACE})'
    )
    parser.add_argument('--out', type=file, metavar='FILE', help='write it instead of printing')
    options = parser.parse_args(arguments)
    shipped = get_package_share_path('hexapod_bringup') / 'layouts' / FILES[options.program]
    name = options.namespace.strip('/')
    text = shipped.read_text(encoding='utf-8')
    text = text.replace(f'/{NAMESPACE}/', f'/{name}/' if name else '/')
    if options.out is None:
        print(text, end='')
    else:
        options.out.write_text(text, encoding='utf-8')


if __name__ == '__main__':
    main()
