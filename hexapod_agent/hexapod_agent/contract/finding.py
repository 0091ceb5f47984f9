# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a check says: the fault, the field, what was expected, and the cure."""

from dataclasses import asdict, dataclass
from typing import Literal

Level = Literal['fault', 'warning', 'note']
"""A fault refuses the sensor, a warning does not; a note says what could not be judged."""


@dataclass(frozen=True)
class Finding:
    """One departure from the contract."""

    kind: str
    """Its class, for programs: 'stopped', 'wrong_unit', ..."""
    channel: str
    """Name in the sensor table."""
    topic: str
    """Name on the graph or in the bag."""
    field: str
    """Of the message, such as 'header.frame_id'."""
    found: str
    """What it is, to be read after the field."""
    expected: str
    """What it should be."""
    cure: str
    """What to do about it."""
    level: Level = 'fault'

    def __str__(self) -> str:
        return (
            f'{self.channel}: {self.topic}: {self.field} {self.found}, '
            f'expected {self.expected}; cure: {self.cure}'
        )

    def as_dict(self) -> dict[str, str]:
        """Return it for JSON."""
        return asdict(self)
