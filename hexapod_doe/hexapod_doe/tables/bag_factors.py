# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The factors of recorded runs, and at which level each run had them."""

from collections.abc import Sequence

from hexapod_sim.sensor_table import LETTERS

from hexapod_doe.bags.run_identity import plan_differences, settings, spec_key, spec_values
from hexapod_doe.bags.run_record import RunRecord
from hexapod_doe.designs.factor import FACTORS, Factor, default_factors, factors_in
from hexapod_doe.errors import BagError, TableError
from hexapod_doe.tables.bag_groups import Group


def factors_of(group: Group, chosen: Sequence[str] | None) -> tuple[Factor, ...]:
    """Return the factors of a group's runs, or those of some letters.

    Raises:
        TableError: The runs are of several experiments, or have no such factor.
    """
    texts = {run.metadata.get(FACTORS, ''): run for run in group.runs}
    if len(texts) > 1:
        names = ' and '.join(run.run_id for run in list(texts.values())[:2])
        raise TableError(
            f'{group.title}: runs of different factors ({names}), expected those of one plan; '
            'give the folder of each campaign by itself'
        )
    plan = group.parts[0].plan
    found = factors_in(group.runs[0].metadata)
    if found is None:
        found = default_factors(plan.factors if plan is not None else LETTERS)
    own = {factor.letter: factor for factor in found}
    for letter in chosen or ():
        if letter not in own:
            raise TableError(
                f'{group.title}: no factor {letter!r}, expected some of {",".join(own)}'
            )
    return tuple(own[letter] for letter in chosen or own)


def shared_settings(run: RunRecord) -> dict[str, str]:
    """Return what a run has in common with those of its plan: all but its factors."""
    varied = {spec_key(factor.key) for factor in factors_in(run.metadata) or ()}
    return {key: value for key, value in settings(run.metadata).items() if key not in varied}


def set_of(run: RunRecord) -> str:
    """Return the letters of the factors at their high level, as the run's bag has them.

    Raises:
        BagError: The bag does not state one, or states another value of its key.
    """
    factors = factors_in(run.metadata)
    if factors is None:
        return known(run, 'observations')
    found, letters = settings(run.metadata), ''
    for factor in factors:
        level = known(run, factor.letter)
        if level not in ('-1', '1'):
            raise BagError(
                f'run {run.run_id}: level {factor.letter} is {level!r}, expected -1 or 1'
            )
        high = level == '1'
        expected = spec_values({factor.key: factor.value(1 if high else -1)})
        if odd := plan_differences(found, expected):
            raise BagError(f'run {run.run_id}: {odd} by the level of factor {factor.name!r}')
        letters += factor.letter if high else ''
    return letters


def known(run: RunRecord, key: str) -> str:
    """Return what a bag must say of its run.

    Raises:
        BagError: It does not.
    """
    if key not in run.metadata:
        raise BagError(f'run {run.run_id}: its metadata lacks the key {key!r}')
    return run.metadata[key]
