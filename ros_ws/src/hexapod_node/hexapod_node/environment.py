# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a process needs of its environment before it loads rclpy, judged without ROS.

rcl ends a process, or raises from its depths, where a variable is wrong or HOME cannot be written.
"""

import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

_MIDDLEWARES = Path('share', 'ament_index', 'resource_index', 'rmw_typesupport')
_LAST_DOMAIN = 232  # the last one whose ports are below 65536, RTPS 2.2, section 9.6.1.1


class EnvironmentVariableError(ValueError):
    """A variable of the environment cannot be used; the text is one line and names it."""


def check_variables() -> None:
    """Check the variables that rcl reads.

    Raises:
        EnvironmentVariableError: RMW_IMPLEMENTATION is not installed, or ROS_DOMAIN_ID is no
            domain.
    """
    _check_middleware(os.environ.get('RMW_IMPLEMENTATION', ''))
    domain_id()


def domain_id() -> int:
    """Return the ROS domain of this process.

    Raises:
        EnvironmentVariableError: ROS_DOMAIN_ID is no domain.
    """
    text = os.environ.get('ROS_DOMAIN_ID', '') or '0'
    if not (text.isascii() and text.isdigit() and int(text) <= _LAST_DOMAIN):
        raise EnvironmentVariableError(
            f"ROS_DOMAIN_ID='{text}', expected a whole number from 0 to {_LAST_DOMAIN}"
        )
    return int(text)


def require_variables() -> None:
    """End the process with one line and status 2 where a variable cannot be used."""
    _require(check_variables)


def require_log_directory() -> None:
    """Provide the folder of ROS's logs, or end the process with one line and status 2."""
    _require(provide_log_directory)


def provide_log_directory() -> Path:
    """Return the folder of ROS's logs, and choose one where HOME has no place for it.

    Then ROS_LOG_DIR names it for this process and its children, and standard error tells where.

    Raises:
        EnvironmentVariableError: ROS_LOG_DIR or ROS_HOME name a folder that cannot be written, or
            no place is left to choose.
    """
    variable, folder = _log_directory()
    reason = _unwritable(folder)
    if folder and not reason:
        return folder
    if variable != 'HOME':
        raise EnvironmentVariableError(
            f"{variable}='{os.environ[variable]}': {reason}, expected a folder that this process "
            'may write'
        )
    chosen = _temporary()
    if chosen is None or _unwritable(chosen):
        raise EnvironmentVariableError(
            f'HOME: {reason}; no temporary folder either, expected ROS_LOG_DIR to be set'
        )
    os.environ['ROS_LOG_DIR'] = str(chosen)
    print(f'HOME: {reason}; ROS logs go to {chosen}, unless ROS_LOG_DIR is set', file=sys.stderr)
    return chosen


def _require(check: Callable[[], object]) -> None:
    try:
        check()
    except EnvironmentVariableError as error:
        print(f'{_program()}: {error}', file=sys.stderr)
        sys.exit(2)


def _program() -> str:
    """Return the name of the command, or of the package that runs as one."""
    path = Path(sys.argv[0])
    return path.parent.name if path.stem == '__main__' else path.stem


def _check_middleware(name: str) -> None:
    prefixes = [*os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep), sys.prefix]
    found = {
        file.name
        for prefix in filter(None, prefixes)
        for file in Path(prefix, _MIDDLEWARES).glob('rmw_*_cpp')
    }
    # Nothing found says that this ROS keeps them elsewhere, not that it has none.
    if name and found and name not in found:
        raise EnvironmentVariableError(
            f"RMW_IMPLEMENTATION='{name}' is not installed, expected "
            f'{" or ".join(sorted(found))}, or the variable unset'
        )


def _log_directory() -> tuple[str, Path | None]:
    """Return the variable that says where rcl writes its logs, and the folder if it is set."""
    if named := os.environ.get('ROS_LOG_DIR'):
        return 'ROS_LOG_DIR', Path(named).expanduser()
    if named := os.environ.get('ROS_HOME'):
        return 'ROS_HOME', Path(named, 'log').expanduser()
    home = os.environ.get('HOME')
    return 'HOME', Path(home, '.ros', 'log') if home else None


def _temporary() -> Path | None:
    """Return a user's folder for logs below the system's temporary one, if there is one."""
    try:
        return Path(tempfile.gettempdir(), f'ros_log_{os.getuid()}')
    except OSError:
        return None


def _unwritable(folder: Path | None) -> str:
    """Return why a folder cannot be made or written, or ''."""
    if folder is None:
        return 'none is set'
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        return f'{folder}: {error.strerror}'
    if not os.access(folder, os.W_OK | os.X_OK):
        return f'{folder}: cannot be written'
    return ''
