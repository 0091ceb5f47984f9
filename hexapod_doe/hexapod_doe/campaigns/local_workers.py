# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Workers of a campaign as processes on this machine, which live no longer than the campaign."""

import os
import shlex
import time
from dataclasses import dataclass
from pathlib import Path

from hexapod_doe.campaigns import children

LIFELINE = 'HEXAPOD_LIFELINE'
"""Environment variable that tells a worker to end when its standard input does."""
_SHORT_LIFE_S = 10.0
_LONGEST_PAUSE_S = 30.0


@dataclass
class _Place:
    """The worker that runs under a number, or that is about to."""

    first_name: str
    process: children.Child | None = None
    lives: int = 0
    """How often a worker was started here."""
    began: float = 0.0
    """When its life began, or the last one ended, on the monotonic clock."""
    short_lives: int = 0
    """How many of the last ones ended at once."""

    @property
    def name(self) -> str:
        """Namespace of the worker; each life has its own."""
        return self.first_name if self.lives <= 1 else f'{self.first_name}_{self.lives}'

    @property
    def pause_s(self) -> float:
        """How long to wait before the next life: not at all after a long one."""
        return min(float((1 << self.short_lives) - 1), _LONGEST_PAUSE_S)

    @property
    def dead(self) -> bool:
        """Whether its process has ended; its identity is not free for others yet."""
        return (
            self.process is not None
            and self.process.returncode is None
            and os.waitid(os.P_PID, self.process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT)
            is not None
        )


class LocalWorkers:
    """Starts one process per worker, starts it again if it dies, and stops them all."""

    def __init__(self, count: int, command: str, logs: Path, files: str = '') -> None:
        """Start the workers.

        Args:
            count: how many.
            command: what starts a worker; `{name}` stands for its namespace, `{files}` for
                the next.
            logs: directory for what they print.
            files: arguments that say which folder and files it may use.
        """
        self._command = command
        self._files = files
        self._logs = logs
        logs.mkdir(parents=True, exist_ok=True)
        self._places = [_Place(f'worker_{n + 1}') for n in range(count)]
        for place in self._places:
            self._start(place)

    def revive(self) -> dict[str, str]:
        """Start again what has died; return how each ended in words, by its name.

        A worker that is started again has a name of its own, so that nobody takes it for the dead
        one, which the network knows for a while. One that ends at once is started ever later.
        """
        ends: dict[str, str] = {}
        for place in self._places:
            if place.dead:
                status = self._bury(place)
                ends[place.name] = f'ended with status {status}, see {self._log(place)}'
            elif place.process is None and time.monotonic() - place.began > place.pause_s:
                self._start(place)
        return ends

    def kill(self, name: str) -> bool:
        """End a worker at once, if it is one of these; `revive` starts it again."""
        for place in self._places:
            if place.name == name and place.process is not None:
                children.kill(place.process)
                return True
        return False

    def stop(self) -> None:
        """Ask every worker to end, and end those that have not after a while."""
        children.stop(place.process for place in self._places if place.process is not None)

    def _bury(self, place: _Place) -> int:
        """Clear what a dead worker leaves, and make ready for the next; return its status."""
        process, place.process = place.process, None
        assert process is not None
        children.kill(process)  # what it had started itself
        short = time.monotonic() - place.began < _SHORT_LIFE_S
        place.short_lives = place.short_lives + 1 if short else 0
        place.began = time.monotonic()
        return process.wait()

    def _log(self, place: _Place) -> Path:
        return self._logs / f'{place.first_name}.log'

    def _start(self, place: _Place) -> None:
        place.lives += 1
        command = shlex.split(self._command.format(name=place.name, files=self._files))
        place.process = children.start(command, self._log(place), {LIFELINE: '1'})
        place.began = time.monotonic()
