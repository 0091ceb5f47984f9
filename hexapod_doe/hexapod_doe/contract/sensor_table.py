# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The outcome of a sensor check on the terminal: a row per topic, then what is wrong and why."""

from __future__ import annotations

from hexapod_agent.contract.finding import Finding
from hexapod_agent.contract.report import SensorReport, TopicRow
from rich.console import Console, JustifyMethod
from rich.table import Table
from rich.text import Text

_STYLES = {'pass': 'green', 'warning': 'yellow', 'fault': 'bold red', 'note': 'dim'}
_RIGHT = ('Hz', 'lag ms')


def show(report: SensorReport, console: Console | None = None) -> None:
    """Print a report."""
    console = console or Console(highlight=False)
    table = Table(box=None, pad_edge=False)
    for head in ('', 'channel', 'topic', 'Hz', 'lag ms', 'frame', ''):
        # Names are there to be copied: they stay whole.
        justify: JustifyMethod = 'right' if head in _RIGHT else 'left'
        table.add_column(head, justify=justify, no_wrap=head != 'channel', overflow='fold')
    for row in report.rows:
        table.add_row(*_cells(row))
    console.print(table)
    for finding in report.findings:
        console.print()
        console.print(_paragraph(finding))
    console.print()
    console.print(_verdict(report))


def _cells(row: TopicRow) -> list[Text]:
    words = [
        row.letter,
        row.channel,
        row.topic,
        '' if row.rate is None else f'{row.rate:.1f}',
        '' if row.lag is None else f'{1e3 * row.lag:.1f}',
        row.frame,
    ]
    return [*map(Text, words), Text(row.verdict, style=_STYLES[row.verdict])]


def _paragraph(finding: Finding) -> Text:
    return Text.assemble(
        (finding.level, _STYLES[finding.level]),
        f' {finding.topic}: ',
        (finding.field, 'bold'),
        f' {finding.found}\n  expected {finding.expected}\n  cure: {finding.cure}',
    )


def _verdict(report: SensorReport) -> Text:
    name = f'Sensors of {report.observations}' if report.observations else 'Sensors'
    if report.passed:
        return Text(f'{name}: pass', style=_STYLES['pass'])
    count = len(report.faults)
    return Text(f'{name}: {count} fault{"s" * (count > 1)}', style=_STYLES['fault'])
