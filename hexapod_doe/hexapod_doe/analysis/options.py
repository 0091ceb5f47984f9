# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The settings of an analysis."""

from dataclasses import dataclass, field, replace
from pathlib import Path

from hexapod_doe.designs.plan_types import Confirmation


@dataclass(frozen=True)
class Options:
    """What the command line sets; the defaults suit any table."""

    terms: str | None = None
    """Terms to fit, such as `A,B,AB`; None for all that the runs can estimate."""
    max_order: int | None = None
    """Highest order of the estimable terms; None for every order."""
    alpha: float = 0.05
    """Significance level of elimination and of Lenth's margins."""
    hierarchy: bool = True
    eliminate: bool | None = None
    """None: eliminate where runs were repeated; False: keep the first model, even saturated."""
    trim_worst: int = 0
    """Runs with the lowest response dropped from each case."""
    transform: str = 'none'
    article: bool = False
    """The procedure of the article: see `as_article`."""
    level: float = 0.9
    """Confidence of every interval."""
    keep_main_effects: bool = False
    """Never eliminate a main effect."""
    estimand: str = 'mean'
    """What is analysed of a case's runs: `mean`, `iqm` or `best_of:m`."""
    failure_threshold: float | None = None
    """Runs below it failed; None for the gap rule."""
    devices: Path | None = None
    """Device table; None for the package's, if the factors are the robot's."""
    delta: float | None = None
    """What a set may be worse than the best; None for the device table's share."""
    confirmation: Confirmation = field(default_factory=Confirmation)
    """The rule for confirmation runs, as the plan fixed it."""
    seed: int = 1
    """Seed of resamples and draws."""

    def as_article(self) -> 'Options':
        """Return the article's procedure, with what was set otherwise left as it is set.

        The worst three runs of ten dropped, a power transform, interactions below 5 % significance
        eliminated, main effects kept.
        """
        return replace(
            self,
            article=True,
            eliminate=self.eliminate is not False,
            trim_worst=self.trim_worst or 3,
            transform='boxcox' if self.transform == 'none' else self.transform,
            keep_main_effects=True,
        )
