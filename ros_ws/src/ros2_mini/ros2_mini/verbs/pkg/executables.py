# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 pkg executables`: what `ros2 run` can run."""

import argparse

from ros2_mini.packages import package_executables, package_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 pkg executables`."""
    parser.add_argument('package_name', nargs='?', help='The package name')
    parser.add_argument(
        '--full-path', action='store_true', help='Show full path of each executable'
    )


def main(args: argparse.Namespace) -> int:
    """Print the executables of one package or of all."""
    for package in [args.package_name] if args.package_name else package_names():
        for path in package_executables(package):
            print(path if args.full_path else f'{package} {path.name}')
    return 0
