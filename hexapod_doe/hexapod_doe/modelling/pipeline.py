# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""From a table to a final model: first fit, trimming, transform, reduction, elimination."""

from dataclasses import dataclass, field

import numpy as np
import pandas as pd

from hexapod_doe.designs.terms import CONSTANT, CURVATURE, is_interaction, order
from hexapod_doe.errors import TableError
from hexapod_doe.fitting.alias_matrix import without_arbitrary
from hexapod_doe.fitting.elimination import Dropped, eliminate, with_parents
from hexapod_doe.fitting.lenth import Lenth, lenth
from hexapod_doe.fitting.model import estimable_terms, model_matrix, parse_terms
from hexapod_doe.fitting.regression import Fit, ols
from hexapod_doe.fitting.transform import Transform, choose_transform
from hexapod_doe.records.options import Options
from hexapod_doe.tables.table import RESPONSE, RunTable


@dataclass(frozen=True)
class FittedStep:
    """A fit, what it is for, and the rows and the scale that it was made on."""

    name: str
    description: str
    fit: Fit
    rows: np.ndarray
    response: np.ndarray
    transformed: bool


@dataclass
class Pipeline:
    """The state that the steps hand on; `steps` grows, the last one is the final model."""

    table: RunTable
    options: Options
    kept: np.ndarray = field(init=False)
    """Which rows are fitted (n,)."""
    steps: list[FittedStep] = field(default_factory=list)
    dropped: tuple[Dropped, ...] = ()
    transform: Transform | None = None
    lenth: Lenth | None = None
    caveats: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.kept = np.ones(len(self.table.rows), dtype=bool)

    @property
    def last(self) -> Fit:
        """The newest fit."""
        return self.steps[-1].fit

    @property
    def levels(self) -> pd.DataFrame:
        """Levels of the rows that are fitted."""
        return self.table.levels[self.kept]

    @property
    def blocks(self) -> np.ndarray:
        """Basis of the differences between the blocks of the rows that are fitted (n, b)."""
        return self.table.block_basis(self.kept)

    def fit(self, name: str, description: str, terms: tuple[str, ...]) -> None:
        """Fit some terms to the kept rows and add the step."""
        response = self.table.values[self.kept]
        if self.transform is not None:
            response = self.transform.forward(response)
        fit = ols(self.levels, response, terms, self.blocks)
        rows = np.flatnonzero(self.kept)
        step = FittedStep(name, description, fit, rows, response, self.transform is not None)
        self.steps.append(step)


def run(table: RunTable, options: Options) -> Pipeline:
    """Run every step that the options ask for and the table allows.

    Raises:
        AliasedTermsError: The named terms cannot be told apart.
        TableError: Trimming would leave a case without runs.
        AnalysisError: A term or the transform cannot be read.
    """
    state = Pipeline(table, options)
    _initial(state)
    if options.trim_worst:
        _trim(state)
    if state.last.df_error == 0 and options.eliminate is not False:
        _reduce(state)
    if options.transform != 'none':
        _transform(state)
    repeated = table.rows.duplicated('case').any()
    wanted = options.eliminate or (options.eliminate is None and (repeated or not state.lenth))
    if wanted and state.last.df_error > 0:
        _eliminate(state)
    return state


def _initial(state: Pipeline) -> None:
    table, options = state.table, state.options
    if options.terms:
        terms = parse_terms(options.terms, table.factors)
        description = f'the {len(terms)} terms named'
    else:
        terms = estimable_terms(table.levels, options.max_order, state.blocks)
        hidden = [t for t in estimable_terms(table.levels, options.max_order) if t not in terms]
        if hidden:
            state.caveats.append(
                f'{", ".join(hidden)} cannot be told from the differences between blocks and is '
                'left out.'
            )
        found, terms = terms, without_arbitrary(table.levels, terms)
        if len(terms) < len(found):
            state.caveats.append(
                'The interactions are confounded with each other in part, and the cases are too '
                'few to tell them apart: the models leave them out. Intervals of what is stated '
                'before elimination allow for them as for random effects.'
            )
        description = f'all {len(terms)} terms that the cases can estimate'
        if options.max_order:
            description += f' up to order {options.max_order}'
    state.fit('initial', description, terms)
    if not table.rows.duplicated('case').any() and state.last.df_error == 0:
        effects = dict(zip(terms, 2 * state.last.coef, strict=True))
        for term in (CONSTANT, CURVATURE):  # neither is a contrast of the factorial runs
            effects.pop(term, None)
        state.lenth = lenth(effects, options.alpha) if len(effects) > 2 else None


def _trim(state: Pipeline) -> None:
    """Drop the worst runs of each case; ties go by the order of the rows."""
    rows, worst = state.table.rows, state.options.trim_worst
    runs = rows.groupby('case')[RESPONSE].size()
    if runs.min() <= worst:
        case = runs.idxmin()
        raise TableError(
            f'case {case} has {runs.min()} run(s): '
            f'dropping the worst {worst} of each case leaves none'
        )
    state.kept = (rows.groupby('case')[RESPONSE].rank(method='first') > worst).to_numpy()
    state.caveats.append(
        f'The worst {worst} runs of each case were dropped ({int((~state.kept).sum())} of '
        f'{len(rows)}): intervals hold for the better runs, not for the mean of all runs.'
    )
    state.fit('trimmed', f'without the worst {worst} runs of each case', state.last.terms)


def _reduce(state: Pipeline) -> None:
    """Replace a saturated model, which leaves no error, by main effects and what stands out."""
    saturated = state.last.terms
    mains = tuple(term for term in saturated if not is_interaction(term))
    beyond = () if state.lenth is None else state.lenth.clearly_active
    wanted = tuple(dict.fromkeys((*mains, *beyond)))
    terms = with_parents(state.levels, wanted, state.blocks)
    if len(terms) > 0.75 * len(saturated):
        terms = mains
    if len(terms) >= len(saturated):
        state.caveats.append(
            'The model has as many terms as there are runs: no standard error, no interval.'
        )
        return
    active = [term for term in terms if is_interaction(term)]
    names = f' and {", ".join(active)}' if active else ''
    state.caveats.append(
        f'The model of all {len(saturated)} terms takes up every run and leaves no error; '
        f"Lenth's method judges its effects. Predictions and intervals come from the main effects"
        f'{names}; their error holds what the other terms explain and is therefore wide.'
    )
    state.fit('reduced', f'main effects{names}, to leave runs for the error', terms)


def _transform(state: Pipeline) -> None:
    response = state.table.values[state.kept]
    matrix = np.column_stack([state.blocks, model_matrix(state.levels, state.last.terms)])
    state.transform = choose_transform(state.options.transform, response, matrix)
    if state.transform is None:
        return
    if state.transform.shift:
        state.caveats.append(
            f'The response was shifted by {state.transform.shift:g} to be positive before its '
            'transform; λ depends on this shift and has no meaning of its own.'
        )
    state.fit(
        'transformed', f'power {state.transform.lambda_:g} of the response', state.last.terms
    )


def _eliminate(state: Pipeline) -> None:
    options, terms = state.options, state.last.terms
    if options.hierarchy:
        terms = with_parents(state.levels, terms, state.blocks)
        if (
            len(terms) > len(state.last.terms)
            and len(terms) < len(state.blocks) - state.blocks.shape[1]
        ):
            added = ', '.join(sorted(set(terms) - set(state.last.terms)))
            state.caveats.append(f'{added} added before elimination to keep the hierarchy.')
        else:
            terms = state.last.terms
    mains = tuple(term for term in terms if order(term) == 1)
    kept, state.dropped = eliminate(
        state.levels,
        state.steps[-1].response,
        terms,
        options.alpha,
        options.hierarchy,
        mains if options.keep_main_effects else (),
        state.blocks,
    )
    if kept == (CONSTANT,):
        state.caveats.append(
            f'No term is significant at {options.alpha:g}: all combinations are predicted alike '
            'and their order says nothing.'
        )
    state.fit('final', f'terms with p ≤ {options.alpha:g}, and parents of the named ones', kept)
