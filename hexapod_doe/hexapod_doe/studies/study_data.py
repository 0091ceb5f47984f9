# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Reads the finished campaigns of a study and analyses each as the study asks."""

from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from scipy import stats

from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.bags.bag_state import sound_metadata
from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.campaigns.row import read_rows
from hexapod_doe.campaigns.stop_rule import stopped_text
from hexapod_doe.modelling.pipeline import Pipeline, run
from hexapod_doe.records.options import Options
from hexapod_doe.records.results import Analysis
from hexapod_doe.tables.bag_table import confirmation_runs, plan_rule, read_bags
from hexapod_doe.tables.fractions import runs_of
from hexapod_doe.tables.table import RunTable

MAIN = 'main'
"""The campaign of the article's question; the others ask it of another learner or task."""
ARTICLE = 'article'
"""The same question of the article's own learner."""
_JOINED = '+'
_ARTICLE_RUNS = 4
"""Fewest runs of a case of which the article's procedure can drop three."""
_MADE = ('git_commit', 'processor', 'machine', 'recording_began', 'recording_ended')


@dataclass(frozen=True)
class StudyCampaign:
    """A finished campaign and what it says."""

    name: str
    table: RunTable
    whole: Analysis
    """Of all its runs."""
    fractions: dict[str, Analysis]
    """Of each fraction that it was planned of, by name."""
    procedures: dict[str, Pipeline]
    """The article's procedure on each fraction that has runs enough."""
    made: pd.DataFrame
    """With what each run was made: commit, processor, machine, times."""

    @property
    def first(self) -> tuple[str, Analysis]:
        """The first of its fractions, which has the most cases."""
        return next(iter(self.fractions.items()))


@dataclass(frozen=True)
class Study:
    """The finished campaigns, by name, and what is not finished."""

    campaigns: dict[str, StudyCampaign]
    left_out: tuple[str, ...]
    """The name of each other campaign, and how far it is."""

    @property
    def main(self) -> StudyCampaign | None:
        """The campaign of the article's question, once it is finished."""
        return self.campaigns.get(MAIN)

    @property
    def tasks(self) -> dict[str, StudyCampaign]:
        """The campaigns of one learner on several tasks."""
        return {name: each for name, each in self.campaigns.items() if name != ARTICLE}


def read_study(folder: Path) -> Study:
    """Read and analyse the finished campaigns below a folder, the main one first.

    Raises:
        BagError: A bag cannot be read.
        AnalysisError: A campaign cannot be analysed.
        hexapod_doe.designs.plan_file.PlanError: A plan cannot be read.
    """
    found: dict[str, StudyCampaign] = {}
    left_out = []
    plans = sorted(folder.glob(f'*/{PLAN_FILE}'), key=lambda p: (p.parent.name != MAIN, p))
    for plan in plans:
        rows = read_rows(plan)
        done = [row for row in rows if row.bag_state().done]
        if len(done) < len(rows) and not stopped_text(plan.parent):
            left_out.append(f'{plan.parent.name} ({len(done)} of {len(rows)} runs)')
            continue
        made = pd.DataFrame([_made(row.bag) for row in done])
        found[plan.parent.name] = _campaign(plan.parent, made)
    return Study(found, tuple(left_out))


def _made(bag: Path) -> dict[str, str]:
    metadata = sound_metadata(bag)
    return {key: metadata.get(key, '') for key in _MADE}


def _campaign(folder: Path, made: pd.DataFrame) -> StudyCampaign:
    table = read_bags([folder])[0]
    options = Options(confirmation=plan_rule([folder]))
    judged = confirmation_runs([folder], table.response, table.settings)
    whole = analyse([table], options, judged)
    names = table.design.split(_JOINED)
    parts = {name: runs_of(table, name) if len(names) > 1 else table for name in names}
    return StudyCampaign(
        name=folder.name,
        table=table,
        whole=whole,
        fractions={
            name: whole if part is table else analyse([part], options)
            for name, part in parts.items()
        },
        procedures={
            name: run(part, Options().as_article())
            for name, part in parts.items()
            if part.rows.groupby('case').size().min() >= _ARTICLE_RUNS
        },
        made=made,
    )


@dataclass(frozen=True)
class Effect:
    """What a factor does to the response: with it less without it, and the interval."""

    factor: str
    effect: float
    low: float
    high: float


def effects_of(analysis: Analysis) -> list[Effect]:
    """Return the effects of the factors by the model of all terms; NaN bounds without error."""
    error = analysis.steps[0].df_error
    reach = float(stats.t.ppf((1 + analysis.level) / 2, error)) if error else float('nan')
    return [
        Effect(each.factor, each.effect, each.effect - half, each.effect + half)
        for each in analysis.main_effects
        for half in [reach * (each.se_effect if each.se_effect is not None else float('nan'))]
    ]
