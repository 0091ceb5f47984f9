# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Where installed packages keep their executables and shared files, from the ament index."""

import os
from pathlib import Path

from ament_index_python import PackageNotFoundError, get_package_prefix

from ros2_mini.errors import CommandError


def package_prefix(package: str) -> Path:
    """Return the install prefix of a package.

    Raises:
        CommandError: If the package is not installed.
    """
    try:
        return Path(get_package_prefix(package))
    except (PackageNotFoundError, ValueError) as error:
        raise CommandError(f"Package '{package}' not found") from error


def package_share(package: str) -> Path:
    """Return the directory of a package's shared files."""
    return package_prefix(package) / 'share' / package


def executable_path(package: str, executable: str) -> Path:
    """Return the path of one executable of a package.

    Raises:
        CommandError: If the package is not installed, or has no such executable, or several.
    """
    paths = sorted(
        path
        for path in (package_prefix(package) / 'lib' / package).rglob('*')
        if path.is_file() and os.access(path, os.X_OK)
    )
    matches = [path for path in paths if path.name == executable]
    if not matches:
        known = ', '.join(path.name for path in paths) or 'none'
        raise CommandError(
            f"No executable found: package '{package}' has no '{executable}'; it has: {known}"
        )
    if len(matches) > 1:
        raise CommandError('\n- '.join(['Multiple executables found:', *map(str, matches)]))
    return matches[0]


def find_in_share(package: str, name: str) -> Path:
    """Return the one file called `name` anywhere below a package's shared files.

    Raises:
        CommandError: If there is no such file, or more than one.
    """
    share = package_share(package)
    matches = sorted(
        Path(folder, name)
        for folder, _, names in os.walk(share, followlinks=True)
        if name in names
    )
    if not matches:
        raise CommandError(
            f"file '{name}' was not found in the share directory of package '{package}' "
            f"which is at '{share}'"
        )
    if len(matches) > 1:
        raise CommandError(
            f"file '{name}' was found more than once in the share directory of package "
            f"'{package}': {[str(path) for path in matches]}"
        )
    return matches[0]
