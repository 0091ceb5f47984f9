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
from hexapod_doe.bags.run_identity import differences, run_identity
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
    def identity(self) -> dict[str, str]:
        """What the plan says of the run: its sensors and its seed."""
        return run_identity({'observations': self.observations, 'seed': str(self.seed)})

    def bag_state(self, shared: Mapping[str, str]) -> BagState:
        """Say whether there is a whole bag at the row's place, and whether it is the row's.

        Args:
            shared: what all runs are to have in common, see `settings`; empty where unknown.
        """
        if not os.path.lexists(self.bag):
            return BagState(whole=False)
        try:
            found = sound_metadata(self.bag)
        except BagError as error:
            return BagState(whole=False, damage=str(error))
        return BagState(True, differences(run_identity(found), self.identity | dict(shared)))


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


def read_rows(plan: Path) -> tuple[Row, ...]:
    """Read the rows of a plan in its run order; their bags are to lie beside it.

    Raises:
        FileNotFoundError: there is no such plan.
        hexapod_doe.designs.plan_file.PlanError: the file is not a plan.
    """
    return rows_of(read_plan(plan), plan.resolve().parent)


def rows_of(plan: Plan, directory: Path) -> tuple[Row, ...]:
    """Return the rows of a plan in its run order; their bags are to lie in a campaign's folder."""
    treatments = plan.treatments
    factors = {} if treatments.default else {FACTORS: treatments.factors_text}
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
