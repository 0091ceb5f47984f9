# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Puts plan and configuration into a campaign's folder, so that it tells everything by itself."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.designs.plan_file import PlanError

CONFIG_FILE = 'config.yaml'
"""Where a campaign's folder has the hyper-parameter file of its runs."""


def place_plan(plan: Path, out: Path | None) -> Path:
    """Return the plan in the campaign's folder, copied there unless it is there.

    Any number of processes may do so at once.

    Args:
        plan: the plan.
        out: the folder; None for the one that the plan is in.

    Raises:
        FileNotFoundError: there is no such plan.
        PlanError: the folder holds another plan.
    """
    if out is None or out.resolve() == plan.resolve().parent:
        return plan
    out.mkdir(parents=True, exist_ok=True)
    there = out / PLAN_FILE
    for suffix in ('.json', '.csv'):  # how the rows were made, then the rows
        source, target = plan.with_suffix(suffix), there.with_suffix(suffix)
        if not target.exists() and (suffix == '.csv' or source.is_file()):
            _copy(source, target)
    if there.read_bytes() != plan.read_bytes():
        raise PlanError(f'{there}: another plan than {plan}, expected the same or none')
    return there


def keep_config(directory: Path, config: str | Path | None) -> None:
    """Copy the hyper-parameter file of a campaign's runs into its folder, if there is one here.

    Raises:
        OSError: the folder cannot be written.
    """
    kept = directory / CONFIG_FILE
    if config and Path(config).is_file() and not (kept.exists() and kept.samefile(config)):
        _copy(Path(config), kept)


def _copy(source: Path, target: Path) -> None:
    """Copy a file so that nobody sees half of it."""
    with tempfile.TemporaryDirectory(dir=target.parent, prefix='.plan') as drafts:
        draft = Path(drafts) / target.name
        shutil.copyfile(source, draft)
        draft.replace(target)
