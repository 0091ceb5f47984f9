# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The two ways in which the nodes keep step, and the parameters that choose between them."""

from hexapod_node.parameters import Parameter

LOCKSTEP = 'lockstep'
REALTIME = 'realtime'

SYNC = Parameter(
    'sync',
    LOCKSTEP,
    'lockstep: one step for each complete period of stamps; realtime: one step per tick of the '
    'clock, with the newest samples',
    choices=(LOCKSTEP, REALTIME),
)


def phase(default: float) -> Parameter:
    """Return the parameter that says when in each control period a node ticks in real time."""
    return Parameter(
        'phase',
        default,
        'realtime: when to tick, from whole control periods of the clock',
        unit='s',
        range=(0.0, 0.025),
    )


def max_age(name: str, topic: str, default: float = 0.1) -> Parameter:
    """Return the parameter that says how old a sample of a topic may be in real time."""
    return Parameter(
        name, default, f'realtime: greatest age of {topic}', unit='s', range=(0.001, 60.0)
    )
