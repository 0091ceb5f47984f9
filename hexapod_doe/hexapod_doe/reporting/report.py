# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Writes an analysis as one self-contained page, with its figures as PNG and its tables as CSV.

The page holds drawings and style sheets itself and may request nothing: its own content policy
forbids it. It reads from the answer over the evidence to the diagnostics.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape

from hexapod_doe.records.results import Analysis, DesignSummary
from hexapod_doe.reporting import next_steps, text
from hexapod_doe.reporting.chapters import CHAPTERS
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.figures.style import theme_css
from hexapod_doe.reporting.tables import Table
from hexapod_doe.reporting.words import level_text, words

_SHORT_TABLE = 16
"""A longer table is folded up."""


@dataclass(frozen=True)
class Section:
    """A chapter of the page with what was made for it."""

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
    design, chosen = analysis.design, text.chosen_standing(analysis)
    environment.tests['chart'] = lambda item: isinstance(item, Chart)
    return environment.get_template('report.html.jinja').render(
        analysis=analysis,
        sections=list(chapters),
        text=text,
        next_steps=next_steps,
        chosen=chosen,
        words=words(design),
        labels={f: _label(design, f, chosen.levels[f]) for f in design.factors},
        light=theme_css(0),
        dark=theme_css(1),
        short=_SHORT_TABLE,
    )


def sections(analysis: Analysis) -> list[Section]:
    """Return the chapters that the analysis has something to say in."""
    named = words(analysis.design)
    noun = named.noun
    made = [
        Section(
            chapter.anchor,
            chapter.title.format(noun=noun),
            chapter.lead.format(noun=noun, held=named.sets_hold),
            chapter.items(analysis),
        )
        for chapter in CHAPTERS
    ]
    return [section for section in made if section.items]


def _label(design: DesignSummary, letter: str, level: float) -> str:
    """Return the name of a sensor, or a factor with its level."""
    if design.sensors or not design.named:
        return design.factor_names.get(letter, '')
    return level_text(design, letter, level)
