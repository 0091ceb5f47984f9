# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Says of a fraction that another one of its size confounds less."""

from collections import Counter

from hexapod_doe.designs.design import Design
from hexapod_doe.designs.terms import LETTERS

_BETTER = {(12, 5): 'H=ABCDE,J=ABCDFG,K=BCEF,L=ABEFG,M=BDG'}
"""Generators with fewer short words than Minitab's, where that is not of minimum aberration; found
by exchanging generators from 400 random starts."""


def aberration_note(design: Design) -> str:
    """Return that a design is not of minimum aberration, and a better one; empty if none is known.

    Of two fractions that one has less aberration which has fewer words of the first length in
    which they differ (Fries and Hunter 1980, Technometrics 22, 601-608).
    """
    size = (len(design.factors), len(design.generators))
    if size not in _BETTER:
        return ''
    letters = str.maketrans(dict(zip(LETTERS, design.factors, strict=False)))
    text = _BETTER[size].translate(letters)
    better = Design('', design.factors, dict(part.split('=') for part in text.split(',')))
    own, least = (Counter(map(len, each.words)) for each in (design, better))
    length = next((n for n in range(1, 1 + size[0]) if own[n] != least[n]), 0)
    if own[length] <= least[length]:
        return ''
    return (
        f'Not of minimum aberration: --generators {text} has {least[length]} words of length '
        f'{length} instead of {own[length]}.'
    )
