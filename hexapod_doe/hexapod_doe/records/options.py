# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The settings of an analysis, declared once: default, range and text of each option."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated

from annotated_types import Interval
from hexapod_sim.command_line import Option, range_fault

from hexapod_doe.designs.plan_types import Confirmation
from hexapod_doe.errors import AnalysisError


@dataclass(frozen=True)
class Options:
    """What the command line sets; the defaults suit any table.

    Raises:
        AnalysisError: A number is out of its range, or two options exclude each other.
    """

    terms: Annotated[
        str | None, Option('terms to fit; the constant is added', metavar='A,B,AB')
    ] = None
    """None for all that the runs can estimate."""
    max_order: Annotated[
        int | None, Interval(ge=1), Option('highest order of the terms', metavar='N')
    ] = None
    """None for every order."""
    alpha: Annotated[
        float, Interval(gt=0, lt=1), Option('significance (default 0.05)', metavar='P')
    ] = 0.05
    """Significance level of elimination and of Lenth's margins."""
    hierarchy: Annotated[bool, Option('keep parents of terms')] = True
    eliminate: Annotated[bool | None, Option('drop terms (default: with repeated runs)')] = None
    """None: eliminate where runs were repeated; False: keep the first model, even saturated."""
    trim_worst: Annotated[
        int, Interval(ge=0), Option('drop the K worst runs of each case', metavar='K')
    ] = 0
    transform: Annotated[str, Option('of the response', metavar='none|log|boxcox|power:L')] = (
        'none'
    )
    article: Annotated[bool, Option("the article's whole procedure")] = False
    """See `as_article`."""
    level: Annotated[
        float, Interval(gt=0, lt=1), Option('of intervals (default 0.9)', metavar='P')
    ] = 0.9
    keep_main_effects: bool = False
    """Never eliminate a main effect."""
    estimand: Annotated[str, Option('of the runs of a case', metavar='mean|iqm|best_of:M')] = (
        'mean'
    )
    failure_threshold: Annotated[
        float | None, Option('runs below X failed (default: a gap)', metavar='X')
    ] = None
    devices: Annotated[Path | None, Option('devices and their cost', metavar='FILE.yaml')] = None
    """None for the package's table, if the factors are the robot's."""
    delta: Annotated[
        float | None, Interval(ge=0), Option('reward that a cheaper set may lose', metavar='D')
    ] = None
    """None for the device table's share of the best."""
    confirmation: Confirmation = field(default_factory=Confirmation)
    """The rule for confirmation runs, as the plan fixed it."""
    seed: Annotated[
        int, Interval(ge=0), Option('of resamples and draws (default 1)', metavar='N')
    ] = 1

    def __post_init__(self) -> None:
        if fault := range_fault(self):
            raise AnalysisError(fault)
        if self.terms and self.max_order:
            raise AnalysisError('terms and max_order exclude each other: give one of them')

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
