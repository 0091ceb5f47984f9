# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A campaign's progress as the page shows it, read from its folder."""

import math
from pathlib import Path
from typing import Any

from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.campaigns.curves import thin
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.overview import summary
from hexapod_doe.campaigns.progress import Progress, Run, State

_POINTS = 48


class CampaignReader:
    """Reads a campaign's folder again and again; runs that are done are read once."""

    def __init__(self) -> None:
        self._folder: Path | None = None
        self._progress: Progress | None = None

    def read(self, folder: Path) -> dict[str, Any]:
        """Return what the folder says, or one line of why it says nothing."""
        if folder != self._folder:
            self._folder, self._progress = folder, None
        known = self._progress.runs if self._progress else None
        try:
            self._progress = read_progress(folder, known)
        except (OSError, ValueError) as error:
            return {'name': folder.name, 'fault': f'{folder / PLAN_FILE}: {error}'}
        return as_record(self._progress)


def as_record(progress: Progress) -> dict[str, Any]:
    """Return figures of a campaign and a row for each run, in plain values."""
    return {
        'name': progress.name,
        'summary': summary(progress),
        'episodes': progress.episodes,
        'planned': progress.planned,
        'legend': list(progress.legend),
        'heading': progress.heading,
        'states': {state.value: len(progress.having(state)) for state in State},
        'runs': [_run(run) for run in progress.runs.values()],
    }


def _run(run: Run) -> dict[str, Any]:
    return {
        'id': run.run_id,
        'label': run.label,
        'state': str(run.state.value),
        'phase': run.phase,
        'worker': run.worker,
        'episodes': len(run.returns),
        'planned': run.planned,
        'reward': None if math.isnan(run.reward) else round(run.reward, 1),
        'reason': run.reason,
        'curve': [round(float(value), 1) for value in thin(run.returns, _POINTS)],
    }
