# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Writes an analysis as one self-contained page, with its figures as PNG and its tables as CSV.

The page holds drawings and style sheets itself and may request nothing: its own content policy
forbids it. It reads from the answer over the evidence to the diagnostics.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape

from hexapod_doe.analysis.results import Analysis, Step
from hexapod_doe.reporting import findings, models, tables, text
from hexapod_doe.reporting.figures import (
    effects,
    learning,
    predictions,
    purchase,
    residuals,
    significance,
)
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.figures.style import theme_css
from hexapod_doe.reporting.tables import Table

_SHORT_TABLE = 16
"""A longer table is folded up."""


@dataclass(frozen=True)
class Section:
    """A chapter of the page."""

    anchor: str
    title: str
    lead: str
    items: tuple[Chart | Table, ...]


def write_report(analysis: Analysis, out: Path) -> Path:
    """Write `index.html`, `figures/*.png` and `tables/*.csv` below a folder.

    Args:
        analysis: What the campaign was found to say.
        out: The folder; it is made if it does not exist.

    Returns:
        The path of the page.
    """
    figure_folder, table_folder = out / 'figures', out / 'tables'
    figure_folder.mkdir(parents=True, exist_ok=True)
    table_folder.mkdir(parents=True, exist_ok=True)
    chapters = sections(analysis)
    for item in (item for section in chapters for item in section.items):
        if isinstance(item, Chart):
            item.save(figure_folder, table_folder)
        else:
            item.save(table_folder)
    page = out / 'index.html'
    page.write_text(render(analysis, chapters), encoding='utf-8')
    return page


def render(analysis: Analysis, chapters: Iterable[Section]) -> str:
    """Return the page."""
    environment = Environment(
        loader=PackageLoader('hexapod_doe.reporting'),
        autoescape=select_autoescape(['html', 'jinja']),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.tests['chart'] = lambda item: isinstance(item, Chart)
    return environment.get_template('report.html.jinja').render(
        analysis=analysis,
        sections=list(chapters),
        text=text,
        chosen=text.chosen_standing(analysis),
        light=theme_css(0),
        dark=theme_css(1),
        short=_SHORT_TABLE,
    )


def sections(analysis: Analysis) -> list[Section]:
    """Return the chapters that the analysis has something to say in."""
    chapters = [_answer(analysis), _purchase(analysis), _evidence(analysis), _doubts(analysis)]
    chapters += [_runs(analysis), _diagnostics(analysis), _record(analysis)]
    return [chapter for chapter in chapters if chapter.items]


def _answer(analysis: Analysis) -> Section:
    return _section(
        'answer',
        'The best sets',
        'Which sensors the best predicted sets hold, and how far apart they are.',
        analysis,
        predictions.top_sets,
        findings.confirmation,
        predictions.ranked_predictions,
        predictions.agreement,
        tables.predictions,
    )


def _purchase(analysis: Analysis) -> Section:
    return _section(
        'purchase',
        'What to buy',
        'One device may give several sensors, so that prices do not add up letter by letter.',
        analysis,
        purchase.cost_front,
        findings.front,
        findings.breakage,
        findings.devices,
    )


def _evidence(analysis: Analysis) -> Section:
    return _section(
        'evidence',
        'What each sensor does',
        'The effects that the predictions are made of.',
        analysis,
        effects.main_effects,
        tables.main_effects,
        effects.interactions,
        models.model_terms,
        significance.pareto,
        significance.half_normal,
    )


def _doubts(analysis: Analysis) -> Section:
    return _section(
        'doubts',
        'What could change the choice',
        'The same runs, looked at in other ways.',
        analysis,
        findings.choices,
        findings.attribution,
        findings.two_part,
        findings.failure_model,
        findings.averaging,
    )


def _runs(analysis: Analysis) -> Section:
    return _section(
        'runs',
        'The trainings',
        'Every run, and how it learned.',
        analysis,
        learning.runs_by_case,
        learning.learning_curves,
        tables.runs,
    )


def _diagnostics(analysis: Analysis) -> Section:
    judged = [step for step in analysis.steps if step.df_error > 0]
    first_and_last = judged if len(judged) < 2 else [judged[0], judged[-1]]
    return _section(
        'diagnostics',
        'How well the model fits',
        'What the models leave unexplained, and how the final one came about.',
        analysis,
        models.steps,
        *(
            _of_step(draw, step)
            for step in first_and_last
            for draw in (residuals.histogram, residuals.normal_probability)
        ),
        *(
            _of_step(draw, step)
            for step in judged[-1:]
            for draw in (residuals.against_fit, residuals.against_order)
        ),
        models.checks,
        models.transform,
        models.elimination,
    )


def _record(analysis: Analysis) -> Section:
    return _section(
        'design',
        'What the design cannot separate',
        'Terms that are always switched together are seen only as a sum.',
        analysis,
        tables.aliases,
    )


def _section(
    anchor: str,
    title: str,
    lead: str,
    analysis: Analysis,
    *makers: Callable[[Analysis], Chart | Table | None],
) -> Section:
    made = (make(analysis) for make in makers)
    return Section(anchor, title, lead, tuple(item for item in made if item is not None))


def _of_step(draw: Callable[[Analysis, Step], Chart], step: Step) -> Callable[[Analysis], Chart]:
    return lambda analysis: draw(analysis, step)
