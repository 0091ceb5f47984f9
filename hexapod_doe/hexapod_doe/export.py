# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `export`: bags as plain tables, for R, Minitab or pandas."""

import sys
from collections.abc import Sequence
from pathlib import Path

import pandas as pd
from hexapod_sim.command_line import CommandLine, one_line, output_file, path

from hexapod_doe.errors import AnalysisError, BagError, TableError
from hexapod_doe.reporting.glossary import meanings
from hexapod_doe.tables.tidy import tidy


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the tables; return 0, or 2 where there is nothing to write or it cannot be."""
    args = _parser().parse_args(arguments)
    try:
        found = tidy(args.bags, meanings())
        tables = {'': found.runs, '_episodes': found.episodes, '_columns': found.columns}
        for suffix, table in tables.items():
            _write(table, args.out.with_name(f'{args.out.stem}{suffix}.csv'))
    except (AnalysisError, BagError, TableError, OSError) as error:
        print(f'export: {one_line(error)}', file=sys.stderr)
        return 2
    for note in found.notes:
        print(f'note: {note}')
    print(f'{len(found.runs)} runs, {len(found.episodes)} episodes -> {args.out}')
    return 0


def _write(table: pd.DataFrame, file: Path) -> None:
    table.to_csv(file, index=False, lineterminator='\n')
    print(f'{file}: {len(table)} rows')


def _parser() -> CommandLine:
    parser = CommandLine(
        prog='export',
        description='Write the complete runs below some folders as plain tables: a row per run in '
        'FILE, a row per episode in FILE_episodes, what the columns mean in FILE_columns.',
    )
    parser.add_argument(
        'bags', nargs='+', type=path, metavar='BAGS', help='folders of campaigns, or above some'
    )
    parser.add_argument(
        '--out', type=output_file(), required=True, metavar='FILE.csv', help='file of the runs'
    )
    return parser


if __name__ == '__main__':
    sys.exit(main())
