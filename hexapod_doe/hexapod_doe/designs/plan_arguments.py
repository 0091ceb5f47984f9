# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The options of the `plan` command line, one parser per command."""

import argparse
from pathlib import Path

from hexapod_agent.specification.spec_text import add_spec_options
from hexapod_sim.command_line import MOST_SEED, CommandLine, file, folder, number, path, whole

from hexapod_doe.designs.design import FRACTIONS

_COUNT = whole(ge=1, le=1_000_000)
_SEED = whole(ge=0, le=MOST_SEED)
_SHARE = number(gt=0, lt=1)
_FACTORS = (
    "The factors are sensors, or by --factors FILE.yaml any keys of a run's specification, each "
    'with a low and a high value: docs/factors.yaml is an example; see `plan make --help`.'
)
COMMANDS = {
    'make': 'make a plan (the default)',
    'fold': 'add the foldover or a semifold of a plan that has been run',
    'augment': 'add the cases that separate confounded terms best',
    'confirm': 'plan new runs of the sets that a campaign chose, by the rule of its plan',
    'aliases': 'print the words of a design and what it confounds, to an order',
    'power': 'say what a design is able to see',
    'hours': 'propose a design for a budget of machine time',
}


def parse(words: list[str]) -> argparse.Namespace:
    """Parse the command line; `command` of the result is a key of `COMMANDS`.

    Without a command's name the words are those of `make`.
    """
    if not words or words[0] not in (*COMMANDS, '-h', '--help'):
        words = ['make', *words]
    return _parser().parse_args(words)


def _parser() -> CommandLine:
    parser = CommandLine(prog='plan', description='Plan a designed experiment.', epilog=_FACTORS)
    commands = parser.add_subparsers(dest='command', required=True)
    made = {name: commands.add_parser(name, help=text) for name, text in COMMANDS.items()}
    _add_make(made['make'])
    _add_fold(made['fold'])
    _add_augment(made['augment'])
    _add_confirm(made['confirm'])
    _add_aliases(made['aliases'])
    _add_power(made['power'])
    _add_hours(made['hours'])
    return parser


def _add_make(parser: CommandLine) -> None:
    _add_design(parser)
    _add_output(parser)
    parser.add_argument(
        '--common-seeds', action='store_true', help='the same seeds in every case, as blocks'
    )
    parser.add_argument(
        '--in-turns',
        action='store_true',
        help='run one replicate of all cases after the other, each in random order, so that a '
        'stop rule may end the campaign between them (default: all rows in one random order)',
    )
    parser.add_argument('--blocks', metavar='WORDS', help='block generators, such as ABE,BCG')
    parser.add_argument(
        '--confirm-runs',
        type=_COUNT,
        default=5,
        metavar='M',
        help='runs that will confirm a chosen set (default 5)',
    )
    parser.add_argument(
        '--confirm-level',
        type=_SHARE,
        default=0.95,
        metavar='P',
        help='confidence of the interval that their mean must lie in (default 0.95)',
    )


def _add_fold(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('plan', type=file, help='the plan.csv that has been run')
    parser.add_argument('--on', required=True, metavar='LETTERS', help='factors that change sign')
    parser.add_argument('--keep', metavar='A+', help='fold only the cases with this level')
    _add_output(parser, replicates=None)


def _add_augment(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('plan', type=file, help='the plan.csv that has been run')
    parser.add_argument('--extra', type=_COUNT, default=8, metavar='N', help='cases to add (8)')
    parser.add_argument(
        '--separate',
        metavar='TERMS',
        help='aliases to tell apart, such as CE,FG; every two-factor interaction by default',
    )
    _add_output(parser, replicates=None)


def _add_confirm(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('campaign', type=path, help="the campaign's folder, or its plan.csv")
    parser.add_argument(
        '--sets',
        metavar='CD,CE',
        help='sets to confirm, by their letters, none for the one without any; by default those '
        'that `analyze` puts first',
    )
    parser.add_argument(
        '--replicates',
        type=whole(1),
        metavar='N',
        help="runs of each set (default by the plan's rule)",
    )
    parser.add_argument(
        '--out', type=file, metavar='FILE', help='file to write (CAMPAIGN/confirm/plan.csv)'
    )


def _add_aliases(parser: CommandLine) -> None:
    _add_design(parser)
    parser.add_argument(
        '--plan',
        type=file,
        nargs='+',
        metavar='FILE',
        help='the cases of these plans together, instead of a design',
    )
    parser.add_argument('--max-order', type=_COUNT, default=2, metavar='N', help='order (2)')


def _add_power(parser: CommandLine) -> None:
    _add_design(parser)
    parser.add_argument('--replicates', type=_COUNT, default=1, metavar='N', help='runs per case')
    parser.add_argument(
        '--max-order', type=_COUNT, default=2, metavar='N', help='order of the model'
    )
    parser.add_argument(
        '--effect', type=number(), metavar='X', help='effect, in the unit of sigma'
    )
    parser.add_argument(
        '--sigma', type=number(gt=0), default=1.0, metavar='X', help='SD of one run'
    )
    parser.add_argument(
        '--alpha', type=_SHARE, default=0.05, metavar='P', help='level of the test'
    )
    parser.add_argument(
        '--failure', type=number(ge=0, lt=1), metavar='P', help='share of runs that fail'
    )
    parser.add_argument(
        '--loss', type=number(), default=0.0, metavar='X', help='how much a failed run loses'
    )
    parser.add_argument(
        '--failure-sigma', type=number(gt=0), metavar='X', help='SD of failed runs'
    )
    parser.add_argument('--repeats', type=_COUNT, default=2000, metavar='N', help='campaigns')
    parser.add_argument('--seed', type=_SEED, default=1, help='seed of the simulation')


def _add_hours(parser: CommandLine) -> None:
    parser.add_argument('--hours', type=number(gt=0), required=True, help='wall time to use')
    known = parser.add_mutually_exclusive_group()
    known.add_argument(
        '--measured',
        type=folder,
        metavar='CAMPAIGN',
        help='folder of a campaign whose finished runs tell the time of a run',
    )
    known.add_argument(
        '--seconds-per-run',
        type=number(gt=0),
        metavar='S',
        help='measured time of a run of --run-episodes (default: as on a shared core)',
    )
    parser.add_argument(
        '--run-episodes',
        type=_COUNT,
        metavar='N',
        help='episodes of the measured run (default: a whole training, as many as --episodes)',
    )
    parser.add_argument(
        '--workers', type=_COUNT, default=1, metavar='N', help='workers side by side'
    )
    parser.add_argument(
        '--episodes',
        type=_COUNT,
        metavar='N',
        help='wanted length of a training (that of --config)',
    )
    _add_factors(parser)
    parser.add_argument('--sigma', type=number(gt=0), metavar='X', help='SD of one run, if known')
    parser.add_argument(
        '--stop-when',
        type=number(gt=0),
        metavar='D',
        help='say also how many runs a campaign with this stop rule is expected to take; in the '
        'unit of --sigma, which it needs',
    )


def _add_design(parser: CommandLine) -> None:
    which = parser.add_mutually_exclusive_group()
    which.add_argument(
        '--design',
        default='eighth',
        metavar='NAME',
        help=f'named fraction: {", ".join(FRACTIONS)}; or several, such as quarter+eighth, whose '
        'shared cases are run once (default eighth)',
    )
    which.add_argument('--generators', metavar='F=ABCD,G=-ABDE', help='generators of the design')
    _add_factors(parser)


def _add_factors(parser: CommandLine) -> None:
    parser.add_argument(
        '--factors',
        default='7',
        metavar='K|FILE.yaml',
        help='how many sensors, or their letters (7); or a file of factors of any kind, a list of '
        'entries with name, key of the specification, low, high, and perhaps device and letter '
        '(docs/factors.yaml is one)',
    )
    add_spec_options(parser)


def _add_output(parser: argparse.ArgumentParser, replicates: int | None = 1) -> None:
    default = 'as in the plan' if replicates is None else replicates
    parser.add_argument(
        '--replicates',
        type=_COUNT,
        default=replicates,
        metavar='N',
        help=f'runs per case (default {default})',
    )
    parser.add_argument('--seed', type=_SEED, default=1, help='seed of run order and run seeds')
    parser.add_argument('--out', type=file, default=Path('plan.csv'), help='file to write')
