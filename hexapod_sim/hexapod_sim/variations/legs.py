# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Variations of whole legs, which an option names."""

from typing import Annotated

from pydantic import AfterValidator

from hexapod_sim.robot import LEGS
from hexapod_sim.variations.variation import Variation, named


def check_legs(text: str) -> str:
    """Return a text that names legs.

    Raises:
        ValueError: It does not.
    """
    named(text, LEGS)
    return text


LegNames = Annotated[str, AfterValidator(check_legs)]
"""Legs with + between them, or none."""


class LegVariation(Variation):
    """A variation of legs.

    Attributes:
        legs: Their names.
    """

    def __init__(self, legs: str) -> None:
        """Take the option's text."""
        self.legs = named(legs, LEGS)

    @property
    def is_present(self) -> bool:
        """Whether there is one."""
        return bool(self.legs)
