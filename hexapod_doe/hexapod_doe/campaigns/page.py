# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Writes a campaign's progress as one self-contained page beside its plan.

The page asks its reader to load it again every half minute, and requests nothing else.
"""

import tempfile
import threading
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape

from hexapod_doe.campaigns.curves import limits, scaled, thin
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.progress import OPEN, Progress, State, duration

PAGE_FILE = 'progress.html'
_RELOAD_S = 30
_POINTS = 32
_WIDTH, _HEIGHT = 96, 24
_PAUSE_S = 2.0


def write_page(progress: Progress, directory: Path) -> Path:
    """Write the page; whoever reads it meanwhile sees the old one or the new one, whole.

    Raises:
        OSError: the disk refuses.
    """
    page = directory / PAGE_FILE
    content = render(progress).encode()
    with tempfile.TemporaryDirectory(dir=directory, prefix='.page') as drafts:
        draft = Path(drafts) / PAGE_FILE
        draft.write_bytes(content)
        draft.replace(page)
    return page


def render(progress: Progress) -> str:
    """Return the page."""
    environment = Environment(
        loader=PackageLoader('hexapod_doe.campaigns'),
        autoescape=select_autoescape(['html', 'jinja']),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    open_runs = progress.having(*OPEN)
    low, high = limits(thin(run.returns, _POINTS) for run in progress.runs.values())
    return environment.get_template('progress.html.jinja').render(
        progress=progress,
        states={state.value: len(progress.having(state)) for state in State},
        points={name: _points(run.returns, low, high) for name, run in progress.runs.items()},
        low=low,
        high=high,
        width=_WIDTH,
        height=_HEIGHT,
        left=duration(progress.seconds_left),
        reload=_RELOAD_S if open_runs and not progress.complete else 0,
        written=datetime.now(UTC),
    )


def _points(returns: list[float], low: float, high: float) -> str:
    """Return a learning curve as the points of an SVG polyline, '' where there is none."""
    curve = scaled(thin(returns, _POINTS), low, high)
    step = _WIDTH / max(len(curve) - 1, 1)
    return ' '.join(f'{k * step:.0f},{_HEIGHT * (1.0 - y):.1f}' for k, y in enumerate(curve))


class PageWriter:
    """Writes the page again after something happened, at most every two seconds."""

    def __init__(self, directory: Path, report: Callable[[str], None]) -> None:
        """Begin to wait.

        Args:
            directory: the campaign's folder.
            report: takes one line where the page cannot be written; the campaign goes on.
        """
        self._directory = directory
        self._report = report
        self._progress: Progress | None = None
        self._failed = False
        self._news = threading.Event()
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._follow, name='page', daemon=True)
        self._thread.start()

    def refresh(self) -> None:
        """Say that something happened, and return at once."""
        self._news.set()

    def close(self) -> None:
        """Write the page as it stays, and end."""
        self._closing.set()
        self._news.set()
        self._thread.join()

    def _follow(self) -> None:
        while not self._closing.is_set():
            self._news.wait()
            self._news.clear()
            self._write()
            self._closing.wait(_PAUSE_S)
        self._write()

    def _write(self) -> None:
        known = self._progress.runs if self._progress else None
        try:
            self._progress = read_progress(self._directory, known)
            write_page(self._progress, self._directory)
        except (OSError, ValueError) as error:  # a page is no reason to stop a campaign
            if not self._failed:
                self._report(f'page of {self._directory} not written: {error}')
            self._failed = True
        else:
            self._failed = False
