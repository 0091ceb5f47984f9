# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The options of the `analyze` command line."""

import argparse

from hexapod_sim.command_line import CommandLine, add_options, folder, path

from hexapod_doe.records.options import Options
from hexapod_doe.tables.bag_response import ARTICLE_RESPONSE, EVALUATION_RESPONSE, RESPONSES

DESCRIPTION = "Analyse a campaign's bags, or any table, and write a report and analysis.json."
_MODEL = (
    'terms', 'max_order', 'alpha', 'hierarchy', 'eliminate', 'trim_worst', 'transform', 'level',
    'article',
)  # fmt: skip


def build_parser() -> CommandLine:
    """Return the parser of `analyze`."""
    parser = CommandLine(prog='analyze', description=DESCRIPTION)
    source = parser.add_argument_group('source')
    source.add_argument(
        'bags', nargs='*', type=path, metavar='BAGS', help='a campaign directory, or bags of runs'
    )
    source.add_argument('--table', type=path, nargs='+', metavar='FILE.csv', help='tables of runs')
    source.add_argument(
        '--response',
        metavar='NAME',
        help=f'column of the tables; of bags {", ".join(RESPONSES)} or a reward term, term_NAME '
        f'or evaluation_term_NAME (default of bags {EVALUATION_RESPONSE}, or {ARTICLE_RESPONSE} '
        'where they have none or with --article)',
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
    source.add_argument(
        '--design',
        nargs='+',
        default=[],
        metavar='NAME',
        help='take apart what was planned as one, such as quarter+eighth: only the runs of this '
        'fraction, or of each of several, which are compared',
    )
    add_options(parser.add_argument_group('model'), Options, _MODEL)
    beyond = parser.add_argument_group('beyond the article')
    add_options(beyond, Options, ('estimand', 'failure_threshold', 'devices', 'delta', 'seed'))
    beyond.add_argument(
        '--confirm',
        type=path,
        nargs='+',
        default=[],
        metavar='RUNS',
        help='judge confirmation runs: a table like that of --table, or directories of bags',
    )
    parser.add_argument(
        '--out', type=folder, required=True, metavar='DIR', help='report directory'
    )
    return parser


def _letters(text: str) -> tuple[str, ...]:
    """Parse the names of factors."""
    names = tuple(filter(None, (part.strip() for part in text.split(','))))
    if not names:
        raise argparse.ArgumentTypeError(f'{text!r}, expected letters such as A,B,C')
    if len(set(names)) < len(names):
        raise argparse.ArgumentTypeError(f'{text!r}, expected each letter once')
    return names
