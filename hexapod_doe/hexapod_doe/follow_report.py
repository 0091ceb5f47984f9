# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `follow_report`: how well a recorded run follows a jumping line."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
from hexapod_sim.command_line import CommandLine, output_file, path
from matplotlib.figure import Figure
from rich.console import Console
from rich.table import Table

from hexapod_doe.errors import BagError
from hexapod_doe.replays.follow import BAND, CHECK_S, Response, Track, read_track, responses
from hexapod_doe.reporting.figures.style import BLUE, GRID, ORANGE, RC, WIDE

_PNG_DPI = 160


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


def draw_following(track: Track) -> Figure:
    """Draw path and line from above with equal scales, and the offset over time below."""
    figure = Figure(figsize=(WIDE, 3.6), layout='constrained')
    above, below = figure.subplots(2, height_ratios=(1, 1.2))
    above.plot(track.x, track.line, color=ORANGE, label='goal line', drawstyle='steps-post')
    above.plot(track.x, track.y, color=BLUE, label='robot')
    above.set_aspect('equal', adjustable='datalim')
    above.set_xlabel('along the line (m)')
    above.set_ylabel('across (m)')
    above.set_title('From above', loc='left')
    above.legend(loc='lower right', bbox_to_anchor=(1.0, 1.0), ncols=2, borderpad=0)
    below.axhspan(-BAND, BAND, color=GRID, linewidth=0)
    below.plot(track.time, track.offset, color=BLUE)
    below.set_xlabel('time (s)')
    below.set_ylabel('offset (m)')
    below.set_title(f'Offset from the line; the band is ±{BAND:g} m', loc='left')
    below.margins(x=0.0)
    return figure


def save_following(track: Track, path: Path) -> None:
    """Write the figure as PNG, SVG or PDF, as the name of the file says."""
    with mpl.rc_context(RC):
        draw_following(track).savefig(path, dpi=_PNG_DPI)


if __name__ == '__main__':
    main()
