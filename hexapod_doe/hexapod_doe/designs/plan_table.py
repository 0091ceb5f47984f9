# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The rows of a campaign's plan: replicates, seeds, blocks and a randomised run order."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from hexapod_doe.designs.aliases import defining_relation, defining_words, resolution
from hexapod_doe.designs.blocks import block_labels
from hexapod_doe.designs.design import Design
from hexapod_doe.designs.factor import Treatments, sensors
from hexapod_doe.designs.plan_types import Confirmation, Plan, PlanSettings

_SEED_RANGE = 2**31
"""Seeds of runs are drawn below this, so that every file format holds them exactly."""


def make_plan(
    design: Design,
    replicates: int = 1,
    seed: int = 1,
    *,
    common_seeds: bool = False,
    in_turns: bool = False,
    blocks: Sequence[str] = (),
    confirmation: Confirmation | None = None,
    treatments: Treatments | None = None,
) -> Plan:
    """Return the plan of a design.

    Args:
        design: The cases.
        replicates: Training runs of each case.
        seed: Seed of the run order and of the runs' seeds.
        common_seeds: Whether replicate r of every case has the same seed (seeds as blocks).
        in_turns: Whether one replicate of all cases is run after the other, as a stop rule asks
            for; else all rows are in one random order.
        blocks: Block generators; blocks run one after the other.
        confirmation: The rule stored with the plan; its seeds are drawn here.
        treatments: What the columns stand for; sensors if None.

    Raises:
        ValueError: The replicates or the blocks don't make sense, or a case has values that no
            run may have.
    """
    return _plan(
        design.levels,
        PlanSettings(
            design=design.name,
            treatments=treatments or sensors(design.factors),
            generators=dict(design.generators),
            defining_relation=defining_relation(design.words),
            resolution=resolution(design.words),
            cases=design.cases,
            replicates=replicates,
            seed=seed,
            common_seeds=common_seeds,
            in_turns=in_turns,
            blocks=tuple(blocks),
            confirmation=confirmation or Confirmation(),
        ),
    )


def follow_up(plan: Plan, levels: np.ndarray, how: str, replicates: int, seed: int) -> Plan:
    """Return a plan for added cases, numbered on from an earlier plan's.

    Args:
        plan: The plan that has been run.
        levels: The added cases. Shape: (extra, factors).
        how: What was added, for the record, such as `foldover on C`.
        replicates: Training runs of each added case.
        seed: Seed of the run order and of the runs' seeds.
    """
    words = defining_words(np.vstack([plan.levels, levels]), plan.factors)
    before = plan.settings
    settings = PlanSettings(
        design=f'{before.design if before else "plan"} + {how}',
        treatments=plan.treatments,
        generators={},
        defining_relation=defining_relation(words),
        resolution=resolution(words),
        cases=len(levels),
        replicates=replicates,
        seed=seed,
        common_seeds=before is not None and before.common_seeds,
        in_turns=before is not None and before.in_turns,
        blocks=_kept_blocks(levels, plan.factors, before.blocks if before else ()),
        follows=how,
        predecessor=plan.fingerprint,
        confirmation=before.confirmation if before else Confirmation(),
    )
    return _plan(levels, settings, plan.rows)


def _kept_blocks(levels: np.ndarray, factors: str, words: Sequence[str]) -> tuple[str, ...]:
    """Return the block generators of a plan for added cases, none if they don't split these."""
    try:
        block_labels(levels, factors, words)
    except ValueError:
        return ()
    return tuple(words)


def _check_training(treatments: Treatments, case: Sequence[float]) -> None:
    """Refuse a case whose runs are none, or would learn nothing."""
    spec = treatments.spec(case)
    try:
        spec.learner.check_training(spec.task.time_limit_steps)
    except ValueError as error:
        raise ValueError(f'case {treatments.text(case)}: {error}') from error


def _plan(levels: np.ndarray, settings: PlanSettings, before: pd.DataFrame | None = None) -> Plan:
    """Return the plan of any cases, numbered on and seeded apart from the rows before them."""
    if settings.replicates < 1:
        raise ValueError(f'{settings.replicates} replicates: expected at least 1')
    if settings.in_turns and settings.blocks:
        raise ValueError(
            'in_turns and blocks exclude each other, as each says what is run after the other: '
            'expected one of them'
        )
    factors, treatments = settings.treatments.letters, settings.treatments
    if not treatments.default:
        for case in levels:  # every one of them can be run
            _check_training(treatments, case)
    first_row = 1 if before is None else 1 + int(before['StdOrder'].max())
    first_case = 1 if before is None else 1 + int(before['case'].max())
    order_rng, seed_rng = map(
        np.random.default_rng, np.random.SeedSequence([settings.seed, first_row]).spawn(2)
    )
    number = np.tile(np.arange(len(levels)), settings.replicates)
    replicate = np.repeat(np.arange(settings.replicates), len(levels))
    seeds, spare = _seeds(settings, len(levels), before, seed_rng)
    blocks = block_labels(levels, factors, settings.blocks)[number]
    if settings.block_column == 'block' and before is not None:  # another time, other blocks
        blocks = blocks + (int(before['block'].max()) if 'block' in before else 1)
    columns: dict[str, Any] = {
        'StdOrder': first_row + np.arange(len(number)),
        'RunOrder': _run_order(blocks, replicate if settings.in_turns else None, order_rng),
        'case': first_case + number,
        'replicate': 1 + replicate,
        **({'block': blocks} if settings.block_column == 'block' else {}),
        'seed': seeds[replicate, number],
        'run_id': [
            f'case{first_case + c:02d}_rep{1 + r:02d}'
            for c, r in zip(number, replicate, strict=True)
        ],
        'observations': [treatments.observations(levels[c]) for c in number],
        **dict(zip(factors, levels[number].T.astype(int), strict=True)),
    }
    confirmation = settings.confirmation
    confirmation = replace(confirmation, seeds=confirmation.seeds or tuple(spare.tolist()))
    return Plan(pd.DataFrame(columns), replace(settings, confirmation=confirmation))


def _seeds(
    settings: PlanSettings, cases: int, before: pd.DataFrame | None, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Draw the seeds of the runs, (replicates, cases), and those of the confirmation runs.

    Common seeds go on with those of the plan before, so that a seed stays a block.
    """
    shared = settings.common_seeds
    count = settings.replicates if shared else settings.replicates * cases
    old = [] if before is None else before['seed'].unique().tolist()
    taken = {*old, *settings.confirmation.seeds}
    wanted = count + settings.confirmation.runs
    drawn = rng.choice(_SEED_RANGE, size=wanted + len(taken), replace=False).tolist()
    fresh = np.array([seed for seed in drawn if seed not in taken][:wanted])
    if not shared:
        return fresh[:count].reshape(settings.replicates, cases), fresh[count:]
    column = np.array([*old, *fresh[:count]])[:count, None]
    return np.broadcast_to(column, (settings.replicates, cases)), fresh[count:]


def _run_order(block: np.ndarray, turn: np.ndarray | None, rng: np.random.Generator) -> np.ndarray:
    """Return 1..N: rows in random order, blocks one after the other in random order.

    Turns, if there are any, come one after the other by their numbers.
    """
    position = rng.permutation(len(block))
    rank_of_block = rng.permutation(block.max() + 1)
    order = np.lexsort((position, rank_of_block[block] if turn is None else turn))
    result = np.empty(len(block), dtype=int)
    result[order] = 1 + np.arange(len(block))
    return result
