# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Keeps what peers may name to one folder: whoever is in the ROS domain may send a request."""

import os
from pathlib import Path

from hexapod_node.parameters import Parameter

ROOT = Parameter(
    'root',
    '',
    'folder below which requests may name paths; empty: bags/ of the working directory',
)
READABLE = Parameter(
    'readable',
    '',
    'further files and folders that requests may name for reading, separated by colons',
)
_SHOWN = 200


class OutsideRootError(ValueError):
    """A request names a path that is not for its sender to name."""


class Root:
    """The folder below which a node reads and writes what it is asked to.

    Attributes:
        folder: absolute, without links.
    """

    def __init__(self, folder: str, readable: str = '') -> None:
        """Look up where the folders are; they need not exist yet.

        Args:
            folder: the parameter `root`.
            readable: the parameter `readable`.
        """
        self.folder = Path(folder or 'bags').expanduser().resolve()
        self._readable = [Path(p).expanduser().resolve() for p in readable.split(':') if p]

    def inside(self, what: str, path: str) -> Path:
        """Return a path to write at, absolute.

        Args:
            what: the field of the request, for the message.
            path: as the request names it.

        Raises:
            OutsideRootError: it does not lie below the root, by its links too.
        """
        return self._checked(what, path, [])

    def readable(self, what: str, path: str) -> Path:
        """Return a path to read at, absolute.

        Raises:
            OutsideRootError: it lies neither below the root nor below what may be read beside.
        """
        return self._checked(what, path, self._readable)

    def _checked(self, what: str, path: str, others: list[Path]) -> Path:
        shown = path if len(path) <= _SHOWN else f'{path[:_SHOWN]}...'
        try:
            real = Path(os.path.realpath(Path(path).expanduser()))
            real.lstat()
        except FileNotFoundError:
            pass
        except (OSError, ValueError, RuntimeError) as error:
            reason = getattr(error, 'strerror', None) or str(error)
            raise OutsideRootError(f"{what} '{shown}': {reason}") from error
        if self.folder not in real.parents and not any(
            other == real or other in real.parents for other in others
        ):
            raise OutsideRootError(
                f"{what} '{shown}': not below '{self.folder}', expected a path that this node may "
                'use; start it with another `root` (docs/security.md)'
            )
        return real


def root_arguments(root: str | Path, readable: str | Path = '') -> list[str]:
    """Return the ROS arguments that give a node its root, to follow `--ros-args`."""
    given = {'root': str(root), 'readable': str(readable)}
    quoted = {name: value.replace("'", "''") for name, value in given.items() if value}
    return [word for name, value in quoted.items() for word in ('-p', f"{name}:='{value}'")]
