# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The plan of confirmation runs: some sets, the seeds that a campaign's plan kept for them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from hexapod_doe.designs.plan_types import Confirmation, Plan, PlanSettings

_EMPTY = ('(none)', 'none')
_SEED_RANGE = 2**31


def confirmation_plan(plan: Plan, sets: Sequence[str], replicates: int | None = None) -> Plan:
    """Return the plan of new runs of some sets.

    Args:
        plan: The campaign's, which fixed the rule before its first run.
        sets: Letters of each set; `(none)` for the empty one.
        replicates: Runs of each set; as many as the rule asks for if None.

    Raises:
        ValueError: There is no set, a letter is unknown, or the rule asks for more runs.
    """
    rule = plan.settings.confirmation if plan.settings else Confirmation()
    runs = rule.runs if replicates is None else replicates
    if runs < rule.runs:
        raise ValueError(
            f'{runs} runs of each set: expected at least the {rule.runs} that the rule of the '
            'plan asks for'
        )
    letters = [_letters(label, plan.factors) for label in dict.fromkeys(sets)]
    if not letters:
        raise ValueError('no set to confirm: expected some, such as --sets CD,CE')
    levels = np.array([[1 if f in each else -1 for f in plan.factors] for each in letters])
    number = np.tile(np.arange(len(letters)), runs)
    replicate = np.repeat(np.arange(runs), len(letters))
    seeds = _seeds(plan, rule, runs)
    rows = pd.DataFrame(
        {
            'StdOrder': 1 + np.arange(len(number)),
            'RunOrder': 1 + np.arange(len(number)),
            'case': 1 + number,
            'replicate': 1 + replicate,
            'seed': seeds[replicate],
            'run_id': [
                f'confirm_{letters[c] or "none"}_rep{1 + r:02d}'
                for c, r in zip(number, replicate, strict=True)
            ],
            'observations': [plan.treatments.observations(levels[c]) for c in number],
            **dict(zip(plan.factors, levels[number].T, strict=True)),
        }
    )
    return Plan(rows, _settings(plan, rule, letters, runs))


def _settings(plan: Plan, rule: Confirmation, letters: Sequence[str], runs: int) -> PlanSettings:
    before = plan.settings
    named = tuple(each or _EMPTY[0] for each in letters)
    return PlanSettings(
        design=f'confirmation of {", ".join(named)}',
        treatments=plan.treatments,
        generators={},
        defining_relation='',
        resolution=None,
        cases=len(letters),
        replicates=runs,
        seed=before.seed if before else 1,
        predecessor=plan.fingerprint,
        confirms=named,
        confirmation=replace(rule, runs=runs),
    )


def _letters(label: str, factors: str) -> str:
    """Return the letters of a set in the order of the factors."""
    given = '' if label.strip() in _EMPTY else label.strip()
    unknown = [letter for letter in given if letter not in factors]
    if unknown or len(set(given)) < len(given):
        raise ValueError(
            f'set {label!r}: expected letters of {factors}, each once, or '
            f'{_EMPTY[1]} for none of them'
        )
    return ''.join(factor for factor in factors if factor in given)


def _seeds(plan: Plan, rule: Confirmation, runs: int) -> np.ndarray:
    """Return the seeds that were stated before, and drawn ones where more are asked for.

    Every set has the same ones. None is of the plan.
    """
    used = {*plan.rows['seed'].tolist(), *rule.seeds}
    seed = plan.settings.seed if plan.settings else 1
    rng = np.random.default_rng(np.random.SeedSequence([seed, int(plan.rows['seed'].iloc[0])]))
    drawn = rng.choice(_SEED_RANGE, size=runs + len(used), replace=False).tolist()
    fresh = [each for each in drawn if each not in used]
    return np.array([*rule.seeds, *fresh][:runs])
