# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Blocks inside a design: which cases run together, and which effects that gives up."""

from collections.abc import Sequence

import numpy as np

from hexapod_doe.designs.aliases import alias_sets
from hexapod_doe.designs.terms import column, normalise, product


def block_labels(levels: np.ndarray, factors: str, words: Sequence[str]) -> np.ndarray:
    """Return the block of each case, 1 to 2^len(words), from block generators.

    Args:
        levels: Coded levels of the design. Shape: (cases, factors).
        factors: The letters of the columns.
        words: Terms whose signs tell the blocks apart, such as `['ABE', 'BCG']`.

    Raises:
        ValueError: A word is unknown, or does not halve every block.
    """
    labels = np.zeros(len(levels), dtype=int)
    for bit, word in enumerate(words):
        labels += (column(levels, factors, normalise(word, factors)) > 0).astype(int) << bit
    sizes = np.bincount(labels, minlength=2 ** len(words))
    if len(set(sizes.tolist())) != 1:
        raise ValueError(
            f'blocks {", ".join(words)}: they give blocks of {sizes.tolist()} cases, '
            'expected independent words that split the cases evenly'
        )
    return labels + 1


def confounded_with_blocks(
    levels: np.ndarray, factors: str, words: Sequence[str], max_order: int = 3
) -> list[str]:
    """Return the alias strings, up to an order, that the difference between blocks hides."""
    hidden = {
        product(*(word for bit, word in enumerate(words) if pick >> bit & 1))
        for pick in range(1, 2 ** len(words))
    }
    columns = [column(levels, factors, word) for word in hidden]
    texts = []
    for group in alias_sets(levels, factors, max_order):
        values = column(levels, factors, group.representative)
        if any(abs(values @ other) == len(levels) for other in columns):
            texts.append(group.text)
    return texts
