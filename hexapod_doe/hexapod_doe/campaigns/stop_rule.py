# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Ends a campaign before its plan is done: once its choice is expected to lose little enough.

After each round of as many finished runs as the plan has cases, from the third round on, the
campaign's analysis is asked. What it said stands in the campaign's folder, for every process and
for later commands: a campaign that its rule ended is complete until somebody says to go on.
"""

import json
import tempfile
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from hexapod_doe.campaigns.row import RUNS_FOLDER
from hexapod_doe.file_lock import lock

STOP_FILE = 'stop.json'
_LOCK_FILE = 'stop.lock'
LEAST_ROUNDS = 3
"""With two runs of a case what is claimed of the choice is far too sure: docs/statistics.md."""


@dataclass(frozen=True)
class Look:
    """What the analysis said of the runs that there were."""

    done: int
    """Finished runs."""
    choice: str
    expected_loss: float | None
    """In units of the response; None where the runs cannot be analysed yet."""
    reason: str = ''
    """Why they cannot."""


@dataclass
class StopRecord:
    """What a campaign's folder holds of its rule."""

    stop_when: float
    looks: list[Look]
    stopped: bool = False

    @property
    def text(self) -> str:
        """How the rule ended the campaign, empty if it did not."""
        if not self.stopped:
            return ''
        last = self.looks[-1]
        return (
            f'complete by its rule: after {last.done} runs {last.choice} is expected to lose '
            f'{last.expected_loss:.3g}, below stop_when {self.stop_when:g}'
        )


def read_stop(directory: Path) -> StopRecord | None:
    """Return what a campaign's folder holds of its rule; None if it has none.

    Raises:
        ValueError: the file is none of a rule.
    """
    file = directory / STOP_FILE
    if not file.is_file():
        return None
    return _parsed(file.read_text(encoding='utf-8'), file)


def stopped_text(directory: Path) -> str:
    """Return how its rule ended a campaign, empty if it did not."""
    record = read_stop(directory)
    return record.text if record else ''


class StopRule:
    """Asks the analysis, and ends the campaign for all who are at it."""

    def __init__(
        self, directory: Path, cases: int, stop_when: float, ask: Callable[[Path], Look]
    ) -> None:
        """Take the rule of a command.

        Args:
            directory: the campaign's folder.
            cases: of its plan: the runs of a round.
            stop_when: expected loss below which no new run is begun; 0 for never.
            ask: returns what the analysis says of the finished runs.
        """
        self._directory, self._cases, self._stop_when = directory, cases, stop_when
        self._ask = ask
        self._rounds = 0

    def due(self) -> bool:
        """Whether a round has been finished since the last look of this process."""
        if not self._stop_when:
            return False
        rounds = _finished(self._directory) // self._cases
        return rounds >= LEAST_ROUNDS and rounds > self._rounds

    def look(self) -> str:
        """Ask the analysis, unless another process does; return how the rule ended the campaign.

        Empty if it goes on.

        Raises:
            OSError: the folder cannot be written.
        """
        self._rounds = rounds = _finished(self._directory) // self._cases
        with (self._directory / _LOCK_FILE).open('a', encoding='utf-8') as held:
            try:
                lock(held)
            except BlockingIOError:
                return ''
            record = read_stop(self._directory) or StopRecord(self._stop_when, [])
            record.stop_when = self._stop_when
            seen = max((each.done // self._cases for each in record.looks), default=0)
            if not record.stopped and seen < rounds:
                record.looks.append(self._ask(self._directory))
                loss = record.looks[-1].expected_loss
                record.stopped = loss is not None and loss < self._stop_when
                _write(record, self._directory)
            return record.text


def go_on(directory: Path) -> None:
    """Let a campaign that its rule ended go on; what was said of it stays on record.

    Raises:
        OSError: the folder cannot be written.
        ValueError: the file is none of a rule.
    """
    record = read_stop(directory)
    if record is not None and record.stopped:
        record.stopped = False
        _write(record, directory)


def _write(record: StopRecord, directory: Path) -> None:
    """Write a record so that nobody sees half of it."""
    with tempfile.TemporaryDirectory(dir=directory, prefix='.stop') as drafts:
        draft = Path(drafts) / STOP_FILE
        draft.write_text(json.dumps(asdict(record), indent=1) + '\n', encoding='utf-8')
        draft.replace(directory / STOP_FILE)


def _finished(directory: Path) -> int:
    """Count the bags that have their name, which they get once they are whole."""
    runs = directory / RUNS_FOLDER
    return sum('.' not in each.name and each.is_dir() for each in runs.glob('*'))


def _parsed(text: str, source: Any) -> StopRecord:
    try:
        found = json.loads(text)
        looks = [Look(**each) for each in found['looks']]
        return StopRecord(float(found['stop_when']), looks, bool(found['stopped']))
    except (ValueError, KeyError, TypeError) as error:
        raise ValueError(f'{source}: not the record of a stop rule ({error})') from error
