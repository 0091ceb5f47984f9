# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `rescore`: what recorded episodes earn with another reward."""

import json
from collections.abc import Sequence
from pathlib import Path
from statistics import mean
from typing import Any

from hexapod_agent.specification.run_spec import ConfigError
from hexapod_sim.command_line import CommandLine, file, one_line, output_file, path
from hexapod_sim.task import TERM_NAMES
from rich.console import Console
from rich.table import Table

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.bag_state import find_bags
from hexapod_doe.errors import BagError
from hexapod_doe.replays.rescoring import Rescored, recorded_config, rescore


def main(arguments: Sequence[str] | None = None) -> None:
    """Score the episodes of one bag or of a folder of them, and print a table."""
    parser = _parser()
    options = parser.parse_args(arguments)
    try:
        rows = [row for bag in _bags(options.bag) for row in _rescored(bag, options.task)]
    except (BagError, ConfigError, OSError) as error:
        parser.error(one_line(error))
    console = Console()
    console.print(_episode_table(rows))
    scored = [row for _, row in rows]
    console.print(_term_table(scored))
    another = options.task is not None and any(
        _is_another(bag, options.task) for bag in _bags(options.bag)
    )
    console.print(_agreement(scored, another), soft_wrap=True)
    if options.json:
        text = json.dumps([_plain(run, row) for run, row in rows], indent=2)
        options.json.write_text(f'{text}\n', encoding='utf-8')


def _parser() -> CommandLine:
    parser = CommandLine(prog='rescore', description=__doc__)
    parser.add_argument('bag', type=path, help='directory of a bag, or a folder of bags')
    parser.add_argument(
        '--task',
        type=file,
        metavar='FILE',
        help='YAML with a section `task` of what changes, in rewards, limits or line; default: '
        'nothing, to see the recorded rewards come out',
    )
    parser.add_argument(
        '--json', type=output_file(), metavar='FILE', help='write the episodes to a file as well'
    )
    return parser


def _bags(path: Path) -> list[Path]:
    """Return the bag, or the bags below a folder that is none."""
    return find_bags(path) or [path] if path.is_dir() else [path]


def _rescored(path: Path, changes: Path | None) -> list[tuple[str, Rescored]]:
    bag = BagFile(path)
    config = recorded_config(bag)
    if changes is not None:
        config = config.changed_by(changes)
    run = bag.metadata().get('run_id', path.name)
    return [(run, row) for row in rescore(bag, config.task)]


def _episode_table(rows: Sequence[tuple[str, Rescored]]) -> Table:
    table = Table('run', 'episode', 'steps', 'end', 'recorded return', 'return')
    for run, row in rows:
        recorded = row.recorded_return
        table.add_row(
            run,
            str(row.episode),
            str(len(row.outcomes)),
            row.cause or 'of the recording',
            'none' if recorded is None else f'{recorded:.2f}',
            f'{row.episode_return:.2f}',
        )
    return table


def _term_table(rows: Sequence[Rescored]) -> Table:
    table = Table('term', 'mean per episode')
    for term in TERM_NAMES:
        table.add_row(term, f'{mean(row.terms[term] for row in rows):.2f}')
    return table


def _is_another(path: Path, changes: Path) -> bool:
    """Whether a file of changes makes another task of the recorded one."""
    config = recorded_config(BagFile(path))
    return config.changed_by(changes).task != config.task


def _agreement(rows: Sequence[Rescored], another: bool) -> str:
    equal, periods = sum(row.equal for row in rows), sum(len(row.recorded) for row in rows)
    if another:
        return (
            'Another task than the recorded one: the recorded returns stand beside it for '
            f'comparison ({equal} of {periods} rewards happen to be the same)'
        )
    return f'{equal} of {periods} recorded rewards come out the same, to the last bit'


def _plain(run: str, row: Rescored) -> dict[str, Any]:
    return {
        'run_id': run,
        'episode': row.episode,
        'steps': len(row.outcomes),
        'end': row.cause,
        'recorded_return': row.recorded_return,
        'return': row.episode_return,
        'terms': row.terms,
        'recorded_periods': len(row.recorded),
        'equal_periods': row.equal,
    }


if __name__ == '__main__':
    main()
