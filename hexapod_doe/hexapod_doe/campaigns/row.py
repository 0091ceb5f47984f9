# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A row of a plan: which run it asks for, and whether its bag is there."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from hexapod_agent.specification.run_spec import RunSpec

from hexapod_doe.bags.bag_state import sound_metadata
from hexapod_doe.bags.run_identity import (
    differences,
    plan_differences,
    run_identity,
    spec_key,
    spec_settings,
    spec_values,
)
from hexapod_doe.campaigns.changes import Changes
from hexapod_doe.designs.factor import FACTORS, Treatments
from hexapod_doe.designs.plan_file import read_plan
from hexapod_doe.designs.plan_types import Plan
from hexapod_doe.errors import BagError

RUNS_FOLDER = 'runs'


@dataclass(frozen=True)
class Row:
    """One training run of the plan."""

    run_id: str
    observations: str
    seed: int
    bag: Path
    """Directory of the run's bag, complete or not yet there."""
    metadata: Mapping[str, str]
    """Every column of the row, for the bag; where a plan has factors of its own also these."""
    treatments: Treatments
    """The factors of the plan and their base."""
    levels: tuple[int, ...]
    """Coded, one per factor."""

    @cached_property
    def spec(self) -> RunSpec:
        """The specification of the run.

        Raises:
            hexapod_agent.specification.run_spec.ConfigError: a factor has no key.
        """
        return self.treatments.spec(self.levels)

    @property
    def label(self) -> str:
        """The short name of its case: sensors, or factors at the high level."""
        return self.treatments.label(self.levels)

    @property
    def text(self) -> str:
        """Its case in words."""
        return self.treatments.text(self.levels)

    @property
    def varied(self) -> frozenset[str]:
        """What differs between the runs of the plan, by its names among their settings."""
        return frozenset(spec_key(factor.key) for factor in self.treatments.factors if factor.key)

    @property
    def shared(self) -> dict[str, str]:
        """What all runs of the plan have in common, see `bags.run_identity.settings`."""
        return self.without_varied(spec_settings(self.treatments.base))

    def without_varied(self, settings: Mapping[str, str]) -> dict[str, str]:
        """Return the settings of a run that others of the plan should have, too."""
        varied = self.varied
        return {key: value for key, value in settings.items() if key not in varied}

    @property
    def identity(self) -> dict[str, str]:
        """What the plan says of the run, whatever base it is trained on: factors and seed."""
        found = run_identity({'observations': self.observations, 'seed': str(self.seed)})
        pairs = zip(self.treatments.factors, self.levels, strict=True)
        return found | spec_values({f.key: f.value(level) for f, level in pairs if f.key})

    @property
    def expected(self) -> dict[str, str]:
        """What decides the run, all of it.

        Raises:
            hexapod_agent.specification.run_spec.ConfigError: a factor has no key.
        """
        own = {'observations': self.spec.letters, 'seed': str(self.seed)}
        return run_identity(own) | spec_settings(self.spec)

    def bag_state(self, whole: bool = False) -> BagState:
        """Say whether there is a whole bag at the row's place, and whether it is the row's.

        Args:
            whole: whether the base of the row is that of the run; else the plan alone is known.
        """
        if not os.path.lexists(self.bag):
            return BagState(whole=False)
        try:
            found = sound_metadata(self.bag)
        except BagError as error:
            return BagState(whole=False, damage=str(error))
        run = run_identity(found)
        return BagState(
            True,
            differences(run, self.expected) if whole else plan_differences(run, self.identity),
        )


@dataclass(frozen=True)
class BagState:
    """What is at the place of a row's bag."""

    whole: bool
    other: str = ''
    """How the run of a whole bag differs from the row; empty if it is the row's."""
    damage: str = ''
    """Why what is there is no whole bag; empty where there is nothing."""

    @property
    def done(self) -> bool:
        """Whether the row has its bag."""
        return self.whole and not self.other


def read_rows(plan: Path, changes: Changes | None = None) -> tuple[Row, ...]:
    """Read the rows of a plan in its run order; their bags are to lie beside it.

    Args:
        plan: its file.
        changes: to the specification that its runs start from.

    Raises:
        FileNotFoundError: there is no such plan.
        hexapod_doe.designs.plan_file.PlanError: the file is not a plan.
        hexapod_agent.specification.run_spec.ConfigError: it cannot be changed so.
    """
    return rows_of(read_plan(plan), plan.resolve().parent, changes)


def rows_of(plan: Plan, directory: Path, changes: Changes | None = None) -> tuple[Row, ...]:
    """Return the rows of a plan in its run order; their bags are to lie in a campaign's folder."""
    treatments = (changes or Changes()).applied(plan.treatments)
    factors = {} if treatments.only_sensors else {FACTORS: treatments.factors_text}
    return tuple(
        Row(
            run_id=row['run_id'],
            observations=row['observations'],
            seed=int(row['seed']),
            bag=directory / RUNS_FOLDER / row['run_id'],
            metadata={str(key): str(value) for key, value in row.items()} | factors,
            treatments=treatments,
            levels=tuple(row[letter] for letter in plan.factors),
        )
        for row in plan.rows.sort_values('RunOrder').to_dict('records')
    )
