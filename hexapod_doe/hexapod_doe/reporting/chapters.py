# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The chapters of a report in reading order: the answer, then the evidence, then the diagnostics.

A chapter names what makes its figures and tables; `report` makes them and writes the page.
"""

from collections.abc import Callable
from dataclasses import dataclass

from hexapod_doe.records.results import Analysis, Step
from hexapod_doe.reporting import findings, glossary, models, tables
from hexapod_doe.reporting.figures import (
    effects,
    learning,
    predictions,
    purchase,
    residuals,
    significance,
)
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.tables import Table

Maker = Callable[[Analysis], Chart | Table | None]
"""Draws or tabulates one thing; None where the analysis has nothing to say about it."""


@dataclass(frozen=True)
class Chapter:
    """A heading, a lead sentence and what stands below them."""

    anchor: str
    title: str
    lead: str
    makers: tuple[Maker, ...]

    def items(self, analysis: Analysis) -> tuple[Chart | Table, ...]:
        """Return the figures and tables that the analysis has something to say in."""
        made = (make(analysis) for make in self.makers)
        return tuple(item for item in made if item is not None)


def _judged(analysis: Analysis) -> list[Step]:
    """Return the steps that left an error to look at."""
    return [step for step in analysis.steps if step.df_error > 0]


def _of_first(draw: Callable[[Analysis, Step], Chart]) -> Maker:
    """Draw the first judged step, unless it is the last one as well."""

    def make(analysis: Analysis) -> Chart | None:
        judged = _judged(analysis)
        return draw(analysis, judged[0]) if len(judged) > 1 else None

    return make


def _of_last(draw: Callable[[Analysis, Step], Chart]) -> Maker:
    """Draw the last judged step."""

    def make(analysis: Analysis) -> Chart | None:
        judged = _judged(analysis)
        return draw(analysis, judged[-1]) if judged else None

    return make


CHAPTERS = (
    Chapter(
        'answer',
        'The best sets',
        'Which {held}, and how far apart they are.',
        (
            tables.factors,
            predictions.top_sets,
            findings.confirmation,
            predictions.ranked_predictions,
            predictions.agreement,
            tables.predictions,
        ),
    ),
    Chapter(
        'purchase',
        'What to buy',
        'One device may give several {noun}s, so that prices do not add up letter by letter.',
        (purchase.cost_front, findings.front, findings.breakage, findings.devices),
    ),
    Chapter(
        'evidence',
        'What each {noun} does',
        'The effects that the predictions are made of.',
        (
            effects.main_effects,
            tables.main_effects,
            effects.interactions,
            models.model_terms,
            significance.pareto,
            significance.half_normal,
        ),
    ),
    Chapter(
        'doubts',
        'What could change the choice',
        'The same runs, looked at in other ways.',
        (
            findings.choices,
            findings.attribution,
            findings.two_part,
            findings.failure_model,
            findings.averaging,
        ),
    ),
    Chapter(
        'runs',
        'The trainings',
        'Every run, and how it learned.',
        (
            learning.runs_by_case,
            learning.learning_curves,
            learning.reward_terms,
            tables.runs,
            glossary.glossary,
        ),
    ),
    Chapter(
        'diagnostics',
        'How well the model fits',
        'What the models leave unexplained, and how the final one came about.',
        (
            models.steps,
            _of_first(residuals.histogram),
            _of_first(residuals.normal_probability),
            _of_last(residuals.histogram),
            _of_last(residuals.normal_probability),
            _of_last(residuals.against_fit),
            _of_last(residuals.against_order),
            models.anova,
            models.checks,
            models.transform,
            models.elimination,
        ),
    ),
    Chapter(
        'design',
        'What the design cannot separate',
        'Terms that are always switched together are seen only as a sum.',
        (tables.aliases, tables.alias_matrix),
    ),
)
