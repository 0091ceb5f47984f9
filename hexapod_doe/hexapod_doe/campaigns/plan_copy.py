# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Puts plan and configuration into a campaign's folder, so that it tells everything by itself."""

import json
import shutil
import tempfile
from pathlib import Path

from hexapod_agent.specification.run_spec import RunSpec

from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.designs.plan_file import PlanError, read_plan

CONFIG_FILE = 'config.yaml'
"""Where a campaign's folder has what its runs start from, if that is not its plan's base."""


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
    if there.read_bytes() != plan.read_bytes() or _factors(there) != _factors(plan):
        raise PlanError(f'{there}: another plan than {plan}, expected the same or none')
    return there


def _factors(plan: Path) -> object:
    """Return what stands in a plan's settings of what its columns mean."""
    settings = plan.with_suffix('.json')
    if not settings.is_file():
        return None
    try:
        found = json.loads(settings.read_text(encoding='utf-8'))
        return found.get('factors'), found.get('base')
    except (ValueError, AttributeError) as error:
        raise PlanError(f'{settings}: not the settings of a plan ({error})') from error


def keep_config(plan: Path, base: RunSpec) -> None:
    """Write what a campaign's runs start from beside its plan, if the plan has it otherwise.

    Their length alone is told by each bag.

    Raises:
        OSError: the folder cannot be written.
    """
    if base.differences(read_plan(plan).treatments.base).keys() <= {'training.episodes'}:
        return
    kept = plan.parent / CONFIG_FILE
    with tempfile.TemporaryDirectory(dir=plan.parent, prefix='.config') as drafts:
        draft = Path(drafts) / CONFIG_FILE
        draft.write_text(base.to_text(), encoding='utf-8')
        draft.replace(kept)


def _copy(source: Path, target: Path) -> None:
    """Copy a file so that nobody sees half of it."""
    with tempfile.TemporaryDirectory(dir=target.parent, prefix='.plan') as drafts:
        draft = Path(drafts) / target.name
        shutil.copyfile(source, draft)
        draft.replace(target)
