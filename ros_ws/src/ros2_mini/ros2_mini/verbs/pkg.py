# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 pkg`: where a package is installed."""

import argparse

from ros2_mini.packages import package_prefix, package_share


def _prefix_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('package_name', help='The package name')
    parser.add_argument(
        '--share', action='store_true', help='Show share directory for the package'
    )


def _prefix(args: argparse.Namespace) -> int:
    """Print the prefix, or the share directory, of the package."""
    find = package_share if args.share else package_prefix
    print(find(args.package_name))
    return 0


VERBS = {'prefix': (_prefix_arguments, _prefix)}
