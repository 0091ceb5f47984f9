# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The cells of a table that `evaluate` fills: settings one by one, and products of values."""

import argparse
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import reduce
from itertools import product
from typing import Any

from hexapod_sim.command_line import CommandLine

from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.specification.spec_text import ConfigError, merged, nest, parsed


@dataclass(frozen=True)
class Cell:
    """One column of a table of training and test, or one row of a grid."""

    values: Mapping[str, Any]
    """What it sets, by dotted keys."""
    spec: RunSpec

    @property
    def text(self) -> str:
        """What it sets, in one line."""
        return ' '.join(f'{key}={value}' for key, value in self.values.items())

    def changed(self, changes: Mapping[str, Any]) -> 'Cell':
        """Return the cell of the same name with some values changed, which go together."""
        return Cell(self.values, self.spec.changed(changes, self.text))


def add_cell_options(parser: CommandLine) -> None:
    """Give a command line the options that `cells` reads."""
    parser.add_argument(
        '--grid',
        action='append',
        default=[],
        metavar='KEY=V,V',
        help='evaluate with each of these values, such as scene.roughness=0,0.01,0.02,0.05; '
        'several are a product; a row for each',
    )
    parser.add_argument(
        '--cell',
        action='append',
        default=[],
        metavar='KEY=V,KEY=V',
        help='evaluate with these values together, such as scene.name=stairs,scene.rise=0.02, or '
        "as it was trained, ''; may be repeated; a row for each, and each with the grid",
    )


def cells(base: RunSpec, options: argparse.Namespace) -> Iterator[Cell]:
    """Yield the cells that a command line asks for; the base alone if it asks for none.

    Raises:
        ConfigError: An option has another form, or a key or value is not allowed.
    """
    given = [_cell(text) for text in options.cell] or [{}]
    grid = [[{key: value} for value in values] for key, values in map(_axis, options.grid)]
    for parts in product(given, *grid):
        values = reduce(lambda one, other: one | other, parts)
        nested: dict[str, Any] = {}
        for key, value in values.items():
            nested = merged(nested, nest(key, value))
        source = ' '.join(f'{key}={value}' for key, value in values.items())
        yield Cell(values, base.changed(nested, source) if values else base)


def _cell(text: str) -> dict[str, Any]:
    """Return what a `--cell` sets."""
    found: dict[str, Any] = {}
    for part in text.split(',') if text else ():
        key, mark, value = part.partition('=')
        if not (key and mark):
            raise ConfigError(f'--cell {text}: expected KEY=VALUE,KEY=VALUE')
        found[key] = parsed(value, f'--cell {text}')
    return found


def _axis(text: str) -> tuple[str, list[Any]]:
    """Return key and values of a `--grid`."""
    key, mark, values = text.partition('=')
    if not (key and mark and values):
        raise ConfigError(
            f'--grid {text}: expected KEY=VALUE,VALUE, such as scene.roughness=0,0.01'
        )
    return key, [parsed(value, f'--grid {text}') for value in values.split(',')]
