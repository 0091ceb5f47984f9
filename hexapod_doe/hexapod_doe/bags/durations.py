# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Durations as people say them."""

_UNITS = (('years', 365.25 * 86400.0), ('days', 86400.0), ('hours', 3600.0), ('minutes', 60.0))


def duration_text(nanoseconds: int) -> str:
    """Return a duration in the largest unit of which it has two, such as '55.8 years'."""
    seconds = nanoseconds * 1e-9
    for name, size in _UNITS:
        if seconds >= 2.0 * size:
            return f'{seconds / size:.1f} {name}'
    return f'{seconds:.1f} s'
