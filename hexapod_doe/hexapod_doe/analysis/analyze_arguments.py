# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The options of the `analyze` command line."""

import argparse
from pathlib import Path

from hexapod_doe.tables.bag_response import DEFAULT_RESPONSE, RESPONSES

DESCRIPTION = "Analyse a campaign's bags, or any table, and write a report and analysis.json."


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of `analyze`."""
    parser = argparse.ArgumentParser(prog='analyze', description=DESCRIPTION)
    boolean = argparse.BooleanOptionalAction
    source = parser.add_argument_group('source')
    source.add_argument(
        'bags', nargs='*', type=Path, metavar='BAGS', help='a campaign directory, or bags of runs'
    )
    source.add_argument('--table', type=Path, nargs='+', metavar='FILE.csv', help='tables of runs')
    source.add_argument(
        '--response',
        metavar='NAME',
        help=f'column of the tables; of bags {", ".join(RESPONSES)} or a reward term, term_NAME '
        f'(default of bags {DEFAULT_RESPONSE})',
    )
    source.add_argument(
        '--factors',
        type=_letters,
        metavar='A,B,…',
        help='one-character columns; others are ignored',
    )
    source.add_argument(
        '--blocks',
        metavar='NAME',
        help='column, or key of the metadata of bags, whose differences are taken out, such as '
        "seed; '' for none (default of bags: what the plan says, or none with --article)",
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


def _letters(text: str) -> tuple[str, ...]:
    return tuple(filter(None, (part.strip() for part in text.split(','))))
