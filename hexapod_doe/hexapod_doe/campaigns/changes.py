# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a command that trains a plan changes of the specification that its runs start from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from hexapod_agent.learning.numerics import resolved
from hexapod_agent.specification.run_spec import ConfigError, RunSpec

from hexapod_doe.designs.factor import OBSERVATIONS, Treatments


@dataclass(frozen=True)
class Changes:
    """Changes to the base of a plan; none unless given."""

    config: str | Path | None = None
    """File of changes."""
    settings: tuple[str, ...] = ()
    """Further ones, each as 'key=value'."""

    @classmethod
    def of(
        cls, config: str | Path | None, settings: Sequence[str], episodes: int | None
    ) -> Changes:
        """Return the changes of a command line, on which the length has an option of its own."""
        length = (f'training.episodes={episodes}',) if episodes else ()
        return cls(config or None, (*(each for each in settings if each), *length))

    def applied(self, treatments: Treatments) -> Treatments:
        """Return the factors of a plan on top of its base with the changes, as it is trained here.

        Raises:
            ConfigError: A change is not one, or is of what the plan decides.
        """
        base = treatments.base if self.config is None else treatments.base.changed_by(self.config)
        base = base.with_settings(self.settings)
        _check_left_alone(base, treatments)
        base = _with_precision(base, treatments)
        return treatments if base == treatments.base else replace(treatments, base=base)


def _check_left_alone(base: RunSpec, treatments: Treatments) -> None:
    """Refuse a base that says otherwise than the plan of what the plan decides.

    Raises:
        ConfigError: It does; the text names the key.
    """
    factors = {factor.key: factor.name for factor in treatments.factors}
    for key, (given, planned) in base.differences(treatments.base).items():
        if key not in factors and not key.startswith(OBSERVATIONS):
            continue
        decided = f'factor {factors[key]!r}' if key in factors else 'the plan'
        raise ConfigError(
            f'{key} is {given!r} by --config or --set, but {decided} decides it in each run: '
            f"expected {planned!r}, as the plan's base has it, or nothing"
        )


def _with_precision(base: RunSpec, treatments: Treatments) -> RunSpec:
    """Return a base with one precision for all runs: the best that their algorithms have."""
    key, plain = 'learner.algorithm', 'float32_fast'
    factors = [factor for factor in treatments.factors if factor.key == key]
    values = [factor.value(level) for factor in factors for level in (-1, 1)]
    found = [resolved(spec) for spec in (base, *(base.with_value(key, v, key) for v in values))]
    if base.training.precision == 'auto' and plain in [s.training.precision for s in found]:
        return base.with_value('training.precision', plain, key)
    return found[0]
