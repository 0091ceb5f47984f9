# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 pkg list`: the installed packages."""

import argparse

from ros2_mini.packages import package_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments: there are none."""


def main(args: argparse.Namespace) -> int:
    """Print one package name a line."""
    for name in package_names():
        print(name)
    return 0
