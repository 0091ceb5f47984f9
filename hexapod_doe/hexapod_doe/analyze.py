# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line: analyse a campaign's bags, or any table, and write report and analysis.json."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from hexapod_doe.analysis import analyse
from hexapod_doe.bag_table import RESPONSE_NAME, bag_responses, plan_rule, read_bags
from hexapod_doe.csv_table import read_csv, read_responses
from hexapod_doe.errors import AnalysisError, BagError
from hexapod_doe.options import Options
from hexapod_doe.report import write_report
from hexapod_doe.results import Analysis, write_json
from hexapod_doe.table import RunTable


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; return 0, or 2 after an error of the user's table or options."""
    parser = build_parser()
    args = parser.parse_args(arguments)
    if bool(args.bags) == bool(args.table):
        parser.error('give either bag directories or --table FILE.csv')
    if args.table and not args.response:
        parser.error('--table needs --response NAME, the column to analyse')
    try:
        analysis = analyse(_tables(args), _options(args), _confirmation_runs(args))
    except (AnalysisError, BagError, FileNotFoundError) as error:
        print(f'analyze: {error}', file=sys.stderr)
        return 2
    args.out.mkdir(parents=True, exist_ok=True)
    write_json(analysis, args.out / 'analysis.json')
    page = write_report(analysis, args.out)
    print(summary(analysis))
    print(f'report: {page}')
    return 0


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of `analyze`."""
    parser = argparse.ArgumentParser(prog='analyze', description=__doc__)
    boolean = argparse.BooleanOptionalAction
    source = parser.add_argument_group('source')
    source.add_argument(
        'bags', nargs='*', type=Path, metavar='BAGS', help='a campaign directory, or bags of runs'
    )
    source.add_argument('--table', type=Path, nargs='+', metavar='FILE.csv', help='tables of runs')
    source.add_argument('--response', metavar='NAME', help='response column of the tables')
    source.add_argument(
        '--factors',
        type=_letters,
        metavar='A,B,…',
        help='one-character columns; others are ignored',
    )
    model = parser.add_argument_group('model')
    terms = model.add_mutually_exclusive_group()
    terms.add_argument('--terms', metavar='A,B,AB', help='terms to fit; the constant is added')
    terms.add_argument('--max-order', type=int, metavar='N', help='highest order of the terms')
    model.add_argument('--alpha', type=float, default=0.05, help='significance (default 0.05)')
    model.add_argument('--hierarchy', action=boolean, default=True, help='keep parents of terms')
    model.add_argument(
        '--eliminate',
        action=boolean,
        default=None,
        help='drop terms (default: with repeated runs)',
    )
    model.add_argument(
        '--trim-worst', type=int, default=0, metavar='K', help='drop the K worst runs of each case'
    )
    model.add_argument(
        '--transform', default='none', metavar='none|log|boxcox|power:L', help='of the response'
    )
    model.add_argument('--level', type=float, default=0.9, help='of intervals (default 0.9)')
    model.add_argument('--article', action='store_true', help="the article's whole procedure")
    beyond = parser.add_argument_group('beyond the article')
    beyond.add_argument(
        '--estimand', default='mean', metavar='mean|iqm|best_of:M', help='of the runs of a case'
    )
    beyond.add_argument(
        '--failure-threshold', type=float, metavar='X', help='runs below X failed (default: a gap)'
    )
    beyond.add_argument(
        '--confirm',
        type=Path,
        nargs='+',
        default=[],
        metavar='RUNS',
        help='judge confirmation runs: a CSV like --table, or directories of bags',
    )
    beyond.add_argument('--devices', type=Path, metavar='FILE.yaml', help='devices and their cost')
    beyond.add_argument(
        '--delta', type=float, metavar='D', help='reward that a cheaper set may lose'
    )
    beyond.add_argument('--seed', type=int, default=1, help='of resamples and draws (default 1)')
    parser.add_argument('--out', type=Path, required=True, metavar='DIR', help='report directory')
    return parser


def summary(analysis: Analysis) -> str:
    """Return the outcome in a few lines for the terminal."""
    lines = [f'{analysis.title}: {len(analysis.table)} runs, {analysis.design.cases} cases']
    for step in analysis.steps:
        numbers = [step.r2, step.r2_adj, step.r2_pred]
        text = ' / '.join('–' if value is None else f'{value:.4f}' for value in numbers)
        lines.append(f'  {step.name:12} {len(step.terms):3} terms  R² / adj / pred  {text}')
    lines += [f'  note: {caveat}' for caveat in analysis.caveats]
    lines.append(f'choice: {analysis.choice} ({analysis.choice_rule})')
    return '\n'.join(lines)


def _tables(args: argparse.Namespace) -> list[RunTable]:
    if args.bags:
        return read_bags(args.bags, args.factors)
    return [table for path in args.table for table in read_csv(path, args.response, args.factors)]


def _options(args: argparse.Namespace) -> Options:
    return Options(
        terms=args.terms,
        max_order=args.max_order,
        alpha=args.alpha,
        hierarchy=args.hierarchy,
        eliminate=args.eliminate,
        trim_worst=args.trim_worst,
        transform=args.transform,
        article=args.article,
        level=args.level,
        estimand=args.estimand,
        failure_threshold=args.failure_threshold,
        devices=args.devices,
        delta=args.delta,
        confirmation=plan_rule(args.bags),
        seed=args.seed,
    )


def _confirmation_runs(args: argparse.Namespace) -> dict[str, list[float]]:
    """Return the responses of the confirmation runs by label."""
    runs: dict[str, list[float]] = {}
    for path in args.confirm:
        found = (
            read_responses(path, args.response or RESPONSE_NAME, args.factors)
            if path.suffix == '.csv'
            else bag_responses(path)
        )
        for label, values in found.items():
            runs.setdefault(label, []).extend(values)
    return runs


def _letters(text: str) -> tuple[str, ...]:
    return tuple(filter(None, (part.strip() for part in text.split(','))))


if __name__ == '__main__':
    sys.exit(main())
