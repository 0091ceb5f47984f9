# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Types of command-line options: what a number or a path may be is said where it is declared."""

import argparse
from collections.abc import Callable
from pathlib import Path

MOST_EPISODES = 10_000_000
MOST_SEED = 2**63 - 1


def whole(least: int, most: int) -> Callable[[str], int]:
    """Return the type of a whole number within limits, both included."""

    def parse(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = least - 1
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(
                f'{text!r}, expected a whole number from {least} to {most}'
            )
        return value

    return parse


def real(least: float, most: float) -> Callable[[str], float]:
    """Return the type of a number within limits, both included; NaN is none."""

    def parse(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = float('nan')
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(
                f'{text!r}, expected a number from {least:g} to {most:g}'
            )
        return value

    return parse


def path(text: str) -> Path:
    """Return a path, `~` being the home folder."""
    try:
        return Path(text).expanduser()
    except RuntimeError as error:  # no such user, or nobody's home
        raise argparse.ArgumentTypeError(f'{text!r}: {error}') from error


def output_file(*endings: str) -> Callable[[str], Path]:
    """Return the type of a file to write, in a folder that is there.

    Args:
        *endings: How its name may end; none for any.
    """

    def parse(text: str) -> Path:
        file = path(text)
        if endings and file.suffix.lower() not in endings:
            raise argparse.ArgumentTypeError(
                f'{text!r}, expected a name that ends in {" or ".join(endings)}'
            )
        if file.is_dir():
            raise argparse.ArgumentTypeError(f'{text!r} is a folder, expected the name of a file')
        if not file.parent.is_dir():
            raise argparse.ArgumentTypeError(
                f'{text!r}: there is no folder {str(file.parent)!r}, expected an existing one'
            )
        return file

    return parse


def output_folder(text: str) -> Path:
    """Return a folder to write to, which is made where it is not there."""
    folder = path(text)
    if folder.exists() and not folder.is_dir():
        raise argparse.ArgumentTypeError(f'{text!r} is a file, expected a folder')
    return folder
