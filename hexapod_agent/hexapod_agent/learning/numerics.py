# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""In which arithmetic a training computes, and what of torch that sets for the whole process.

torch takes longer to import than a plan takes to make: it is imported where it is asked.
"""

from functools import cache

from hexapod_agent.specification.run_spec import ConfigError, RunSpec

_KEY = 'training.precision'


def set_numerics(precision: str) -> None:
    """Let torch compute as `TrainingConfig.precision` says, and the same to the last bit always.

    Whoever steps through a training calls it before the first update; acting sets nothing.
    """
    import torch

    # One thread: a sum split over threads is not the same to the last bit.
    torch.set_num_threads(1)
    torch.set_float32_matmul_precision('highest' if precision == 'float32' else 'medium')


@cache
def computes_bfloat16() -> bool:
    """Return whether this processor has instructions for products of such numbers."""
    import torch

    instructions = torch.cpu.get_capabilities()
    return any(has for name, has in instructions.items() if name.endswith('bf16'))


def resolved(spec: RunSpec) -> RunSpec:
    """Return the specification of a run that begins here, with a precision that is no choice.

    It is what the run's record says, and what a campaign holds all of its runs to.
    """
    if spec.training.precision != 'auto':
        return spec
    short = spec.learner.has_bfloat16 and computes_bfloat16()
    return spec.with_value(_KEY, 'bfloat16' if short else 'float32_fast', _KEY)


def check_precision(spec: RunSpec) -> None:
    """Refuse a training that this processor would take ten times as long for.

    Raises:
        ConfigError: It is one.
    """
    if spec.training.precision == 'bfloat16' and not computes_bfloat16():
        raise ConfigError(
            f"{_KEY} is 'bfloat16', for which this processor has no instructions: an update would "
            "take 40 to 70 ms; expected 'float32_fast', or 'auto', which chooses by the processor"
        )
