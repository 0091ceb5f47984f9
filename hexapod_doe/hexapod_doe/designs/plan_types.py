# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a campaign's plan is: its table of runs, how it was made, how it will be confirmed."""

import hashlib
import json
from dataclasses import asdict, dataclass, field, fields
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd

from hexapod_doe.designs.factor import Treatments, sensors


@dataclass(frozen=True)
class Confirmation:
    """The rule that confirmation runs will be judged by, fixed before the first run."""

    runs: int = 5
    """m, the new training runs of each set that is confirmed."""
    level: float = 0.95
    """Confidence of the prediction interval of their mean."""
    seeds: tuple[int, ...] = ()
    """Their seeds, none of which the plan uses."""

    def __post_init__(self) -> None:
        if self.runs < 1:
            raise ValueError(f'{self.runs} confirmation runs: expected at least 1')
        if not 0 < self.level < 1:
            raise ValueError(f'confirmation level {self.level}: expected between 0 and 1')

    @property
    def rule(self) -> str:
        """The rule in words."""
        return (
            f'A set is confirmed if the mean response of {self.runs} new runs lies within the '
            f'{100 * self.level:g} % prediction interval of the mean of {self.runs} runs, as the '
            'final model gives it before these runs are started.'
        )


_ORDER = (
    'design', 'factors', 'generators', 'defining_relation', 'resolution', 'cases', 'replicates',
    'seed', 'common_seeds', 'in_turns', 'blocks', 'follows', 'base', 'confirms', 'confirmation',
)  # fmt: skip
"""How a file lists the settings of a plan."""


@dataclass(frozen=True)
class PlanSettings:
    """How a plan was made; stored beside it, enough to make it again."""

    design: str
    treatments: Treatments
    generators: dict[str, str]
    defining_relation: str
    resolution: int | None
    cases: int
    replicates: int
    seed: int
    common_seeds: bool = False
    in_turns: bool = False
    """Whether one replicate of all cases is run after the other."""
    blocks: tuple[str, ...] = ()
    follows: str = ''
    """What an augmenting plan adds to, and how; empty for a first plan."""
    predecessor: str = ''
    """Fingerprint of the plan that it adds to, or whose choice it confirms; empty for none."""
    confirms: tuple[str, ...] = ()
    """The sets that its runs confirm; empty for a plan whose runs are fitted."""
    confirmation: Confirmation = field(default_factory=Confirmation)

    @property
    def block_column(self) -> str:
        """The column that tells the blocks of its runs apart; empty if there are none.

        What follows another plan is run at another time: a block of its own, or several.
        """
        if self.blocks:
            return 'block'
        return 'seed' if self.common_seeds else 'block' if self.follows else ''

    def as_dict(self) -> dict[str, Any]:
        """Return plain types, with the confirmation rule in words.

        Sensors on top of article.yaml are their letters, and `base` is the plan before, as in
        files from before there were other factors.
        """
        values = {each.name: getattr(self, each.name) for each in fields(self)}
        treatments, before = values.pop('treatments'), values.pop('predecessor')
        values['confirmation'] = asdict(self.confirmation) | {'rule': self.confirmation.rule}
        if treatments.default:
            own = {'factors': treatments.letters, 'base': before}
        else:
            own = {**treatments.as_dict(), 'predecessor': before}
        return {name: (values | own)[name] for name in dict.fromkeys((*_ORDER, *own, *values))}


@dataclass(frozen=True)
class Plan:
    """A table of training runs, in standard order, and how it was made.

    Columns: StdOrder, RunOrder, case, replicate, (block,) seed, run_id, observations, then one
    column of -1 and +1 per factor.
    """

    rows: pd.DataFrame
    settings: PlanSettings | None

    @property
    def factors(self) -> str:
        """The factor letters: the one-letter columns."""
        return ''.join(name for name in self.rows.columns if len(name) == 1)

    @cached_property
    def treatments(self) -> Treatments:
        """What the columns of the factors stand for: sensors where no file says otherwise."""
        return self.settings.treatments if self.settings else sensors(self.factors)

    @property
    def fingerprint(self) -> str:
        """What tells its runs from those of any other plan."""
        columns = ['run_id', 'observations', 'seed']
        own = '' if self.treatments.default else json.dumps(self.treatments.as_dict())
        columns += list(self.factors) if own else []
        rows = self.rows.sort_values('StdOrder')[columns]
        text = rows.to_csv(index=False, lineterminator='\n') + own
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    @property
    def levels(self) -> np.ndarray:
        """The coded levels of each case, once. Shape: (cases, factors)."""
        return self.rows.drop_duplicates('case')[list(self.factors)].to_numpy()
