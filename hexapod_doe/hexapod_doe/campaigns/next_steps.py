# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What to type next: from a plan over its runs and their analysis to the confirmation."""

import json
import shlex
from collections.abc import Sequence
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

from hexapod_agent.specification.run_spec import RunSpec

from hexapod_doe.bags.run_identity import EPISODES, differences
from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.plan_copy import CONFIG_FILE
from hexapod_doe.campaigns.progress import Progress, Run, State
from hexapod_doe.campaigns.row import read_rows
from hexapod_doe.cores import usable_cores
from hexapod_doe.designs.plan_file import read_plan

CONFIRM_FOLDER = 'confirm'
"""Where a campaign's confirmation runs are."""
_LENGTH = 'training.episodes'
_RUN = 'ros2 run hexapod_doe'
_FLEET = '/fleet'


def after_status(folder: Path, progress: Progress) -> list[str]:
    """Return the lines to type after a look at a campaign: to watch it while it runs."""
    if progress.having(State.RUNNING):
        return [f'ros2 run hexapod_bringup watch {_quoted(folder)}']
    if not progress.complete:
        return (
            [] if progress.having(State.OTHER) else [_train(folder, progress, folder / PLAN_FILE)]
        )
    settings = read_plan(folder / PLAN_FILE).settings
    if settings is not None and settings.confirms:
        main = folder.parent
        return [_analyze(main)] if (main / PLAN_FILE).is_file() else []
    return _confirming(folder, progress) or [_analyze(folder)]


def after_analysis(folder: Path, sets: Sequence[str], again: str) -> list[str]:
    """Return the lines that confirm what an analysis chose.

    Args:
        folder: of the campaign.
        sets: to confirm.
        again: the line that was typed for the analysis.
    """
    if not (folder / PLAN_FILE).is_file():
        return []
    progress = read_progress(folder)
    if not progress.complete:
        return [*after_status(folder, progress), again]
    if _confirm_plan(folder).is_file():
        left = _confirming(folder, progress)
        return [*left, again] if left else []
    plain = ','.join('none' if label == '(none)' else label for label in sets)
    line = f'{_RUN} plan confirm {_quoted(folder)} --sets {plain}'
    return [line, _train(folder, progress, _confirm_plan(folder)), again]


def after_tour() -> list[str]:
    """Return the line to type after a campaign that is too short to decide by."""
    swift = Path(str(files('hexapod_agent') / 'swift.yaml')).resolve()
    near = swift.relative_to(Path.cwd()) if swift.is_relative_to(Path.cwd()) else swift
    cores = usable_cores()
    return [f'{_RUN} plan hours --hours 8 --workers {cores} --config {_quoted(near)}']


def after_single_runs(folder: Path) -> list[str]:
    """Return the line to type after a campaign that leaves no error to state intervals with."""
    return [f'{_RUN} plan hours --hours 8 --workers {usable_cores()} --measured {_quoted(folder)}']


def after_confirmation(folder: Path, levels: Sequence[int]) -> list[str]:
    """Return the lines that train an agent with the set that a campaign chose, and judge it.

    Args:
        folder: of the campaign.
        levels: of the set, -1 or 1 for each factor of the plan.
    """
    treatments = read_plan(folder / PLAN_FILE).treatments
    if (folder / CONFIG_FILE).is_file():
        changed = treatments.base.changed_by(folder / CONFIG_FILE)
        treatments = replace(treatments, base=changed)
    spec = treatments.spec(levels)
    begun = [run for run in read_progress(folder).runs.values() if run.settings]
    episodes = max((run.planned for run in begun), default=spec.training.episodes)
    words = ['ros2', 'run', 'hexapod_agent', 'train', '--seed', '1', '--episodes', str(episodes)]
    words += ['--observations', spec.letters] if spec.letters else []
    for key, (value, _) in spec.differences(RunSpec.load()).items():
        told = key == _LENGTH or key.startswith('observations.') or value is None
        words += [] if told else ['--set', f'{key}={json.dumps(value)}']
    out = f'runs/{treatments.label(levels)}'
    return [
        shlex.join([*words, '--out', out]),
        f'ros2 run hexapod_agent evaluate {out}/agent.pt --starts 50',
    ]


def after_confirm(folder: Path, plan: Path) -> list[str]:
    """Return the lines to type once the runs that confirm are planned."""
    return [_train(folder, read_progress(folder), plan), _analyze(folder, plan)]


def _confirming(folder: Path, progress: Progress) -> list[str]:
    """Return the line that goes on with a campaign's confirmation runs, if some are to come."""
    plan = _confirm_plan(folder)
    if not plan.is_file():
        return []
    return [] if read_progress(plan.parent).complete else [_train(folder, progress, plan)]


def _confirm_plan(folder: Path) -> Path:
    return folder / CONFIRM_FOLDER / PLAN_FILE


def _train(folder: Path, progress: Progress, plan: Path) -> str:
    """Return the line that trains a plan as the runs of a campaign were trained."""
    begun = [run for run in progress.runs.values() if run.settings]
    episodes = max((run.planned for run in begun), default=0)
    fleet = any(run.worker == _FLEET for run in begun)
    given = {'episodes': str(episodes)} if episodes else {}
    if config := _config(folder, begun):
        given['config'] = config
    if fleet:
        options = [f'--{key} {value}' for key, value in given.items()]
        return ' '.join([f'{_RUN} run_fleet --plan {_quoted(plan)}', *options])
    options = [f'{key}:={value}' for key, value in given.items()]
    launch = f'ros2 launch hexapod_bringup campaign.launch.xml plan:={_quoted(plan)}'
    return ' '.join([launch, *options])


def _config(folder: Path, begun: Sequence[Run]) -> str:
    """Return the file of what runs start from; 'FILE' where the folder lacks it, '' for none."""
    if (folder / CONFIG_FILE).is_file():
        return _quoted(folder / CONFIG_FILE)
    if not begun:
        return ''
    expected = read_rows(folder / PLAN_FILE)[0].shared | {EPISODES: str(begun[0].planned)}
    return 'FILE' if differences(begun[0].settings, expected) else ''


def _analyze(folder: Path, confirm: Path | None = None) -> str:
    line = f'{_RUN} analyze {_quoted(folder)} --out {_quoted(folder / "report")}'
    apart = confirm is not None and confirm.parent != folder / CONFIRM_FOLDER
    return f'{line} --confirm {_quoted(confirm.parent)}' if confirm and apart else line


def _quoted(path: Path) -> str:
    return shlex.quote(str(path))
