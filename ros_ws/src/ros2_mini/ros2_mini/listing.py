# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the verbs `list` share: their options, and names printed with their types."""

import argparse
from collections.abc import Sequence

NamesAndTypes = Sequence[tuple[str, list[str]]]


def add_types_argument(parser: argparse.ArgumentParser, kind: str) -> None:
    """Declare the option that shows types of a kind such as 'topic'."""
    parser.add_argument(
        '-t', '--show-types', action='store_true', help=f'Additionally show the {kind} type'
    )


def add_count_argument(parser: argparse.ArgumentParser, kind: str) -> None:
    """Declare the option that counts a kind, as `args.count`."""
    parser.add_argument(
        '-c', f'--count-{kind}s', action='store_true', dest='count',
        help=f'Only display the number of {kind}s discovered',
    )  # fmt: skip


def add_hidden_argument(parser: argparse.ArgumentParser, kind: str) -> None:
    """Declare the option that lists hidden ones too, as `args.hidden`."""
    parser.add_argument(
        f'--include-hidden-{kind}s', action='store_true', dest='hidden',
        help=f'Consider hidden {kind}s as well',
    )  # fmt: skip


def print_names(found: NamesAndTypes, args: argparse.Namespace) -> None:
    """Print how many were found, or one name a line, with its types where asked."""
    if args.count:
        print(len(found))
        return
    for name, types in found:
        print(f'{name} [{", ".join(types)}]' if args.show_types else name)
