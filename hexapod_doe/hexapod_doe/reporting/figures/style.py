# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How every figure looks: a palette with a light and a dark value for each role, and the type.

Figures are drawn in the light values. In the page each value is replaced by a CSS variable, so
that one drawing serves both themes. Blue against orange is told apart by readers of every kind
of colour vision; shape and fill repeat what colour says.
"""

from typing import Any

INK, MUTED, GRID, SURFACE = '#1c2128', '#57606a', '#d9dee4', '#fefefe'
BLUE, ORANGE, TEAL, PURPLE = '#0a62b0', '#bf4b00', '#0b7a75', '#7b3fa0'

ROLES = {
    'ink': (INK, '#e6edf3'),
    'muted': (MUTED, '#9aa4ae'),
    'grid': (GRID, '#363e48'),
    'surface': (SURFACE, '#12161c'),
    'blue': (BLUE, '#6cb6ff'),
    'orange': (ORANGE, '#f69d50'),
    'teal': (TEAL, '#4fd1c5'),
    'purple': (PURPLE, '#c79bff'),
}
"""Role -> its value on a light and on a dark page."""

SERIES = (BLUE, ORANGE, TEAL, PURPLE)
"""Colours of the designs that are compared, in order."""
MARKERS = ('o', '^', 's', 'D')
"""Their markers."""

RC: dict[Any, Any] = {
    'text.parse_math': False,  # names of factors are taken as they are
    'axes.axisbelow': True,
    'axes.edgecolor': MUTED,
    'axes.facecolor': 'none',
    'axes.grid': True,
    'axes.grid.axis': 'y',
    'axes.labelcolor': MUTED,
    'axes.labelsize': 9,
    'axes.linewidth': 0.7,
    'axes.spines.right': False,
    'axes.spines.top': False,
    'axes.titlecolor': INK,
    'axes.titlesize': 9,
    'errorbar.capsize': 0,
    'figure.facecolor': SURFACE,
    'font.family': 'sans-serif',
    'font.sans-serif': ['DejaVu Sans'],
    'font.size': 9,
    'grid.color': GRID,
    'grid.linewidth': 0.6,
    'legend.fontsize': 9,
    'legend.frameon': False,
    'legend.labelcolor': INK,
    'lines.linewidth': 1.4,
    'lines.markersize': 5,
    'svg.fonttype': 'none',
    'text.color': INK,
    'xtick.color': MUTED,
    'xtick.labelsize': 8.5,
    'xtick.major.size': 0,
    'ytick.color': MUTED,
    'ytick.labelsize': 8.5,
    'ytick.major.size': 0,
}
"""Settings of matplotlib while a figure is drawn and saved."""

WIDE, NARROW = 7.2, 3.5
"""Widths of a figure and of half of one, in inches of 72 units."""


def theme_css(theme: int) -> str:
    """Return the CSS variables of the light (0) or the dark (1) theme."""
    return ' '.join(f'--{role}: {values[theme]};' for role, values in ROLES.items())
