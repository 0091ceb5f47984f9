# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The figure of a line that jumps and the robot that follows it: from above, and over time."""

from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure

from hexapod_doe.replays.follow import BAND, Track
from hexapod_doe.reporting.figures.style import BLUE, GRID, ORANGE, RC, WIDE

_PNG_DPI = 160


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
