# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a launch says: to the screen, and to a `launch.log` below the ROS log directory."""

import datetime
import os
import socket
import time
from pathlib import Path
from types import TracebackType

from hexapod_node.environment import provide_log_directory


def make_log_directory() -> Path:
    """Create and return a directory of its own for the log of this launch.

    It lies in ROS_LOG_DIR, else in ROS_HOME/log, else in ~/.ros/log.

    Raises:
        EnvironmentVariableError: none of them can be written.
    """
    base = provide_log_directory()
    stamp = datetime.datetime.now().strftime('%Y-%m-%d-%H-%M-%S-%f')
    directory = base / f'{stamp}-{socket.gethostname()}-{os.getpid()}'
    directory.mkdir(parents=True)
    return directory


class LaunchLog:
    """Writes the lines of a launch and of its processes; a context manager."""

    def __init__(self, directory: Path) -> None:
        self._file = (directory / 'launch.log').open('w', buffering=1, encoding='utf-8')

    def __enter__(self) -> 'LaunchLog':
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._file.close()

    def say(self, level: str, name: str, text: str) -> None:
        """Write a message of the launch itself, about the process `name` or about `launch`."""
        self._write(f'[{level}] [{name}]: {text}', f'[{level}] [{name}] {text}')

    def line(self, name: str, text: str, *, screen: bool, file: bool) -> None:
        """Write a line that the process `name` has put out."""
        line = f'[{name}] {text}'
        self._write(line if screen else None, line if file else None)

    def _write(self, screen: str | None, file: str | None) -> None:
        if screen is not None:
            print(screen)
        if file is not None:
            self._file.write(f'{time.time():.7f} {file}\n')
