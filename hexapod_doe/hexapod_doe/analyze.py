# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line: analyse a campaign's bags, or any table, and write report and analysis.json."""

import argparse
import shlex
import sys
from collections.abc import Sequence
from dataclasses import replace

from hexapod_sim.command_line import one_line, options_of

from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.analysis.analysis_json import write_json
from hexapod_doe.analysis.analyze_arguments import build_parser
from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.campaigns.next_steps import (
    after_analysis,
    after_confirmation,
    after_single_runs,
    after_tour,
)
from hexapod_doe.designs.plan_file import PlanError
from hexapod_doe.errors import AnalysisError, BagError, TableError
from hexapod_doe.records.options import Options
from hexapod_doe.records.results import Analysis
from hexapod_doe.reporting.report import write_report
from hexapod_doe.reporting.text import is_tour
from hexapod_doe.reporting.words import set_text
from hexapod_doe.stages import stage
from hexapod_doe.tables.bag_response import ARTICLE_RESPONSE
from hexapod_doe.tables.bag_table import bag_responses, confirmation_runs, plan_rule, read_bags
from hexapod_doe.tables.csv_table import read_csv, read_responses
from hexapod_doe.tables.fractions import runs_of
from hexapod_doe.tables.table import RunTable


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; return 0, or 2 after an error of the user's table or options."""
    parser = build_parser()
    args = parser.parse_args(arguments)
    if bool(args.bags) == bool(args.table):
        parser.error('give either bag directories or --table FILE.csv')
    if args.table and not args.response:
        parser.error('--table needs --response NAME, the column to analyse')
    try:
        options = Options(**options_of(Options, args), confirmation=plan_rule(args.bags))
        with stage('analyze: reading the runs'):
            tables = _tables(args)
            confirmation = _confirmation_runs(args, tables)
        with stage('analyze: fitting the model, and drawing from its uncertainty'):
            analysis = analyse(tables, options, confirmation)
        analysis = replace(analysis, next_steps=_next_steps(args, analysis, arguments))
        args.out.mkdir(parents=True, exist_ok=True)
        with stage(f'analyze: drawing the figures of the report into {args.out}'):
            write_json(analysis, args.out / 'analysis.json')
            page = write_report(analysis, args.out)
    except (AnalysisError, BagError, PlanError, OSError) as error:
        print(f'analyze: {one_line(error)}', file=sys.stderr)
        return 2
    print(summary(analysis))
    print(f'report: {page}')
    if analysis.next_steps:
        print('\n'.join(['next:', *(f'  {line}' for line in analysis.next_steps)]))
    return 0


def summary(analysis: Analysis) -> str:
    """Return the outcome in a few lines for the terminal."""
    lines = [f'{analysis.title}: {len(analysis.table)} runs, {analysis.design.cases} cases']
    for step in analysis.steps:
        numbers = [step.r2, step.r2_adj, step.r2_pred]
        text = ' / '.join('–' if value is None else f'{value:.4f}' for value in numbers)
        lines.append(f'  {step.name:12} {len(step.terms):3} terms  R² / adj / pred  {text}')
    lines += [f'  note: {caveat}' for caveat in analysis.caveats]
    chosen = next(p.levels for p in analysis.predictions if p.label == analysis.choice)
    levels = '' if analysis.design.sensors else f' = {set_text(analysis.design, chosen)}'
    lines.append(f'choice: {analysis.choice}{levels} ({analysis.choice_rule})')
    if analysis.expected_loss is not None:
        lines.append(f'expected loss of this choice: {analysis.expected_loss:.3g}')
    return '\n'.join(lines)


def _tables(args: argparse.Namespace) -> list[RunTable]:
    tables = _whole_tables(args)
    if not args.design:
        return tables
    return [runs_of(table, name) for table in tables for name in args.design]


def _whole_tables(args: argparse.Namespace) -> list[RunTable]:
    if args.bags:
        for path in args.bags:
            if path.is_file():
                raise TableError(
                    f'{path}: is a file; give bags by their folder, and a table by --table'
                )
        response = args.response or (ARTICLE_RESPONSE if args.article else None)
        # The article knows no blocks, whatever the plan says.
        blocks = '' if args.article and args.blocks is None else args.blocks
        return read_bags(args.bags, args.factors, response, blocks)
    return [
        table
        for path in args.table
        for table in read_csv(path, args.response, args.factors, args.blocks or '')
    ]


def _confirmation_runs(
    args: argparse.Namespace, tables: Sequence[RunTable]
) -> dict[str, list[float]]:
    """Return the responses of the confirmation runs by label, those below a campaign too."""
    response = args.response or tables[0].response
    factors, like = tables[0].factors, tables[0].settings
    if not args.confirm:
        return confirmation_runs(args.bags, response, like) if args.bags else {}
    runs: dict[str, list[float]] = {}
    for path in args.confirm:
        found = (
            bag_responses(path, response, like)
            if path.is_dir()
            else read_responses(path, response, args.factors)
        )
        if not found:
            raise TableError(f'{path}: no bag of a complete run, expected confirmation runs')
        for label, values in found.items():
            if set(label) <= set(factors):  # a file's columns may stand in another order
                label = ''.join(factor for factor in factors if factor in label)
            runs.setdefault(label, []).extend(values)
    return runs


def _next_steps(
    args: argparse.Namespace, analysis: Analysis, arguments: Sequence[str] | None
) -> tuple[str, ...]:
    """Return what to type next; nothing where no campaign of a plan was analysed."""
    campaigns = [path for path in args.bags if (path / PLAN_FILE).is_file()]
    first = next((path for path in campaigns if path.resolve().name == analysis.title), None)
    if first is None:
        return ()
    if is_tour(analysis):
        return tuple(after_tour())
    found = analysis.confirmation
    if found is None:
        return tuple(after_single_runs(first))
    if any(check.observed for check in found.checks):
        levels = next(p.levels for p in analysis.predictions if p.label == analysis.choice)
        return tuple(after_confirmation(first, list(levels.values())))
    if args.confirm:
        return ()
    again = shlex.join(['ros2', 'run', 'hexapod_doe', 'analyze', *(arguments or sys.argv[1:])])
    sets = [check.label for check in found.checks]
    return tuple(after_analysis(first, sets, again))


if __name__ == '__main__':
    sys.exit(main())
