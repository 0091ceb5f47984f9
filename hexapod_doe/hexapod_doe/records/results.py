# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The record of one analysis: what the report draws and what `analysis.json` holds."""

import dataclasses
from collections.abc import Mapping
from typing import Any

import pandas as pd
from hexapod_sim.sensor_table import LETTERS
from statsmodels.regression.linear_model import OLS, RegressionResults

from hexapod_doe.designs.factor import Factor
from hexapod_doe.errors import AnalysisError
from hexapod_doe.fitting.anova import AnovaRow
from hexapod_doe.fitting.blocks import BlockTest, block_basis
from hexapod_doe.fitting.curvature import Curvature
from hexapod_doe.fitting.lenth import Lenth
from hexapod_doe.fitting.model import model_matrix
from hexapod_doe.fitting.pure_error import LackOfFit
from hexapod_doe.fitting.transform import Transform
from hexapod_doe.records.findings import (
    Attribution,
    Averaging,
    Confirmation,
    EstimandResult,
    Estimate,
    Purchase,
    RankUncertainty,
    TwoPart,
)

Interval = tuple[float | None, float | None]


@dataclasses.dataclass(frozen=True)
class DesignSummary:
    """The design as the rows of the table show it."""

    name: str
    """What the source calls it, such as `quarter`, or else its size, such as `2^(7-2)`."""
    factors: tuple[str, ...]
    factor_names: Mapping[str, str]
    """Letter to what it switches on, such as `A` to `joint torques`; may be empty."""
    named: tuple[Factor, ...]
    """The factors with their keys and levels; empty for tables of other programs."""
    defining_relation: str
    resolution: int | None
    cases: int
    expected_cases: int
    """Cases of the regular fraction that the rows span; more than `cases` if some are missing."""
    missing_cases: tuple[str, ...]
    runs: int
    replicates: tuple[int, int]
    """Fewest and most runs in a case."""
    centre_points: int
    block_column: str
    """What the runs are blocked by, such as `seed`; empty if by nothing."""
    blocks: int
    """How many blocks; 0 if none."""
    aliases: Mapping[str, str]
    """Each estimable term and its alias string."""

    @property
    def sensors(self) -> bool:
        """Whether a set of letters is a set of sensors, as far as is known."""
        if not self.named:
            return set(self.factors) <= set(LETTERS)
        return all(factor.is_sensor for factor in self.named)


@dataclasses.dataclass(frozen=True)
class Step:
    """One fitted model. Maps go from term to number; what does not exist is None."""

    name: str
    """`initial`, `trimmed`, `transformed`, `reduced` or `final`."""
    description: str
    scale: str
    """`response`, or `transformed`: what coef, se, s, sse and residuals are measured in."""
    n: int
    terms: tuple[str, ...]
    aliases: Mapping[str, str]
    coef: Mapping[str, float]
    se: Mapping[str, float | None]
    t: Mapping[str, float | None]
    p: Mapping[str, float | None]
    effects: Mapping[str, float]
    se_effects: Mapping[str, float | None]
    r2: float | None
    r2_adj: float | None
    r2_pred: float | None
    press: float | None
    r2_pred_cases: float | None
    """As r2_pred, leaving out all runs of a case at once."""
    press_cases: float | None
    s: float | None
    df_error: int
    sse: float
    sst: float
    vif: Mapping[str, float]
    """How much correlation with other terms swells the variance of each; 1 for none."""
    anova: tuple[AnovaRow, ...]
    """Adjusted sums of squares by source; empty without an error."""
    lack_of_fit: LackOfFit | None
    blocks: BlockTest | None
    """Whether the blocks differ; None without blocks."""
    rows: tuple[int, ...]
    """Index in `Analysis.table` of each row that was fitted."""
    response: tuple[float, ...]
    fitted: tuple[float, ...]
    residuals: tuple[float, ...]
    leverage: tuple[float, ...]
    studentized: tuple[float | None, ...]
    """Externally studentised residuals; beyond ±3 a row is flagged as an outlier."""


@dataclasses.dataclass(frozen=True)
class MainEffect:
    """Response with and without one factor, on the rows named by `Analysis.main_effects`.

    Fitted means average the model over all combinations of the other factors, alike for both
    (least-squares means). Raw means are of the runs that there are: where cases have unequal runs
    they mix what other factors do into the difference.
    """

    factor: str
    fitted_with: float | None
    fitted_without: float | None
    """None for a factor that the cases cannot tell from others."""
    se_fitted_with: float | None
    se_fitted_without: float | None
    """None if the first model is saturated."""
    effect: float
    """Difference of the fitted means; of the raw ones where there are none."""
    se_effect: float | None
    mean_with: float
    mean_without: float
    """Raw means."""
    se_mean_with: float | None
    """Standard deviation within the group over the root of its size."""
    se_mean_without: float | None


@dataclasses.dataclass(frozen=True)
class Removal:
    """One step of the backward elimination."""

    step: int
    term: str
    alias: str
    p: float
    s: float
    r2: float | None
    r2_adj: float | None
    """s, R² and adjusted R² of the model without the term."""


@dataclasses.dataclass(frozen=True)
class Prediction:
    """One of the 2^k combinations, in original units; a bound outside the transform is None."""

    label: str
    levels: Mapping[str, int]
    fit: float
    ci: Interval
    """Confidence interval of the mean (of the median after a transform)."""
    pi: Interval
    """Prediction interval of one new run."""
    se: float | None
    """Standard error of the fit on the fitted scale."""
    rank: int
    """1 is best; ties share the order of the table of combinations."""
    tested: bool
    """Whether the combination was run."""
    alias_safe: bool
    """Whether the fit is the same whichever of its aliases each term is named after."""


@dataclasses.dataclass(frozen=True)
class Analysis:
    """Everything that one campaign was found to say."""

    title: str
    source: str
    response: str
    options: Mapping[str, Any]
    """The settings of the command line, defaults filled in."""
    design: DesignSummary
    table: pd.DataFrame
    """One row per run: run_id, case, replicate, run_order, label, factors, response, kept
    (False where trimmed), failed."""
    curves: pd.DataFrame
    """Learning curves: run_id, label, case, replicate, episode, return, average; may be empty."""
    caveats: tuple[str, ...]
    """What a reader must know before believing the numbers, in full sentences."""
    main_effects: tuple[MainEffect, ...]
    """On all rows, before trimming."""
    steps: tuple[Step, ...]
    """In order; the last one is the final model, from which the predictions come."""
    elimination: tuple[Removal, ...]
    transform: Transform | None
    lenth: Lenth | None
    """For unreplicated designs: which effects stand out without an estimate of error."""
    curvature: Curvature | None
    level: float
    """Confidence of every interval, such as 0.9."""
    predictions: tuple[Prediction, ...]
    """All 2^k combinations in Yates order."""
    ranking: tuple[str, ...]
    """Labels of the combinations, best fit first."""
    choice: str
    """Label of the recommended combination."""
    choice_rule: str
    """Why that one, in a sentence."""
    expected_loss: float | None = None
    """What it is expected to lose against the best combination; None without an error."""
    estimands: tuple[EstimandResult, ...] = ()
    two_part: TwoPart | None = None
    rank_uncertainty: RankUncertainty | None = None
    attribution: Attribution | None = None
    averaging: Averaging | None = None
    confirmation: Confirmation | None = None
    purchase: Purchase | None = None
    against_all: Estimate | None = None
    """How much the choice earns more than the whole set; None where the model leaves no error."""
    next_steps: tuple[str, ...] = ()
    """Lines to type next."""
    compared: tuple['Analysis', ...] = ()
    """Other designs over the same factors, analysed with the same options."""

    @property
    def final(self) -> Step:
        """The final model."""
        return self.steps[-1]

    def model(self, name: str) -> RegressionResults:
        """Return a fitted step as statsmodels' results, for `summary()` and all else they offer.

        Its parameters go by their terms, those of the differences between blocks by
        `block 1`, `block 2` and so on; with blocks its intervals are those of the blocks that
        there are, where `predictions` allows for others.

        Args:
            name: Of the step; `final` is the last one, whether or not a term was eliminated.

        Raises:
            AnalysisError: There is no such step.
        """
        found = {step.name: step for step in self.steps} | {'final': self.final}
        if name not in found:
            raise AnalysisError(f'no step {name!r}, expected one of {", ".join(found)}')
        step = found[name]
        rows = self.table.iloc[list(step.rows)]
        columns = pd.DataFrame(
            model_matrix(rows[list(self.design.factors)], step.terms), columns=list(step.terms)
        )
        if self.design.block_column:
            basis = block_basis(rows['block'].to_numpy())
            columns[[f'block {number + 1}' for number in range(basis.shape[1])]] = basis
        return OLS(pd.Series(step.response, name=self.response), columns).fit()

    def ranked(self) -> tuple[Prediction, ...]:
        """Return the predictions, best first."""
        return tuple(sorted(self.predictions, key=lambda prediction: prediction.rank))
