# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `follow_report`: how well a recorded run follows a jumping line."""

from collections.abc import Sequence

from hexapod_sim.command_line import CommandLine, output_file, path
from rich.console import Console
from rich.table import Table

from hexapod_doe.errors import BagError
from hexapod_doe.replays.follow import BAND, CHECK_S, Response, read_track, responses
from hexapod_doe.reporting.figures.follow import save_following


def main(arguments: Sequence[str] | None = None) -> None:
    """Draw the path and print each jump's settling time, overshoot and remaining offset."""
    parser = CommandLine(prog='follow_report', description=__doc__)
    parser.add_argument('bag', type=path, help='directory of the bag of one episode')
    parser.add_argument('--out', type=output_file(), help='figure to write; default BAG.png')
    options = parser.parse_args(arguments)
    out = options.out or options.bag.with_name(f'{options.bag.name}.png')
    try:
        track = read_track(options.bag)
    except BagError as error:
        parser.error(str(error))
    found = responses(track)
    if not found:
        parser.error(f'bag {options.bag}: the line stays, expected one that jumps')
    save_following(track, out)
    console = Console()
    console.print(_table(found))
    console.print(f'figure: {out}', soft_wrap=True)


def _table(found: Sequence[Response]) -> Table:
    table = Table(
        'jump at (s)',
        'jump (m)',
        f'settled within {BAND:g} m after (s)',
        'overshoot (m)',
        f'|offset| after {CHECK_S:g} s (m)',
    )
    for response in found:
        settled = response.settling_time == response.settling_time  # NaN is not
        table.add_row(
            f'{response.time:.3f}',
            f'{response.jump:+.2f}',
            f'{response.settling_time:.2f}' if settled else 'never',
            f'{response.overshoot:.3f}',
            f'{response.offset_after:.3f}',
        )
    return table


if __name__ == '__main__':
    main()
