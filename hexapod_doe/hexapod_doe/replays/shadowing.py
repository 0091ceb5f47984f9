# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Shows an agent what a bag holds, and compares what it would have asked with what was asked.

The agent sees the samples that carry the command's stamp, as it would on the live graph: a played
checkpoint then repeats its lock-step bag to the last bit. Where a topic has no sample of that
stamp, as in real time, the newest one before it counts.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from hexapod_agent.algorithms.policies import Policy
from hexapod_agent.nodes.messages import decode
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_agent.specification.sections import CpgConfig
from hexapod_cpg.mapping import (
    ACTION_SIZE,
    COMMAND_FIELDS,
    Command,
    action_from_command,
    command_from_action,
)
from hexapod_sim.robot import LEGS
from numpy.typing import NDArray

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.errors import BagError
from hexapod_doe.replays.episodes import Series, Span

COMMAND = 'cpg/command'
COMMAND_TYPE = 'hexapod_interfaces/msg/CpgCommand'
Action = NDArray[np.float32]
Values = NDArray[np.float64]
Answer = tuple[int, Values, Values]
"""Stamp of a command in ns, its recorded fields, and those of the agent."""


@dataclass(frozen=True)
class Difference:
    """A number of a command that the agent would have chosen otherwise.

    Attributes:
        period: from the episode's begin.
        stamp_ns: of the command.
        field: of the command, with the leg.
        recorded: what was asked, in the unit of the field.
        shadow: what the agent would have asked.
    """

    period: int
    stamp_ns: int
    field: str
    recorded: float
    shadow: float

    @property
    def size(self) -> float:
        """Distance of the two, in the unit of the field."""
        return abs(self.shadow - self.recorded)


@dataclass(frozen=True)
class Comparison:
    """An agent against one recorded episode.

    Attributes:
        episode: its number in the run.
        periods: commands compared.
        equal: those whose numbers are all the same to the last bit.
        aged: periods in which a topic had no sample of the command's stamp.
        first: the first difference; None if all are equal.
        largest: the largest one.
    """

    episode: int
    periods: int
    equal: int
    aged: int
    first: Difference | None
    largest: Difference | None


class Recorded:
    """What a bag holds of an agent's senses and of the commands that were given.

    Attributes:
        commands: by their stamps.
    """

    def __init__(self, bag: BagFile, spec: ObservationSpec) -> None:
        """Read the topics that the agent observes.

        Raises:
            BagError: one is missing.
        """
        self.commands = Series(bag, COMMAND, COMMAND_TYPE)
        self._bag = bag
        self._spec = spec
        self._sensors = {
            topic: Series(bag, topic, channel.message_type)
            for channel in spec.channels
            for topic in channel.topics
        }

    def observation(self, stamp_ns: int, previous: Action) -> Action:
        """Return what the agent observes at a stamp, after an action.

        Raises:
            BagError: a topic has no sample until then, or one that cannot be observed.
        """
        messages = {topic: series.newest(stamp_ns) for topic, series in self._sensors.items()}
        absent = [topic for topic, message in messages.items() if message is None]
        if absent:
            raise BagError(
                f'bag {self._bag.path}: no sample of {", ".join(absent)} until '
                f'{stamp_ns * 1e-9:.3f} s, expected one before the first command'
            )
        readings: dict[str, NDArray[np.float64]] = {}
        try:
            for channel in self._spec.channels:
                if channel.topics:
                    readings.update(decode(channel, messages))
            return self._spec.assemble(readings, previous)
        except ValueError as error:
            raise BagError(f'bag {self._bag.path}: at {stamp_ns * 1e-9:.3f} s: {error}') from error

    def aged(self, stamp_ns: int) -> bool:
        """Whether a topic has no sample of the stamp itself."""
        return any(series.at(stamp_ns) is None for series in self._sensors.values())


def shadow(recorded: Recorded, span: Span, policy: Policy, cpg: CpgConfig) -> Comparison:
    """Compare an agent's commands with those of one episode.

    Args:
        recorded: what the agent observes and what was asked.
        span: the episode.
        policy: the agent, from observation to action.
        cpg: how an action becomes a command.

    Raises:
        BagError: something observed is missing.
    """
    stamps = recorded.commands.within(span)
    aged = sum(recorded.aged(stamp) for stamp in stamps)
    return compare(span.episode, _answers(recorded, stamps, policy, cpg), aged)


def compare(episode: int, answers: Iterable[Answer], aged: int = 0) -> Comparison:
    """Compare recorded commands of an episode with those of an agent.

    Args:
        episode: number in its run.
        answers: a stamp with both commands, for each period in turn.
        aged: periods in which a topic had no sample of the command's stamp.
    """
    periods = equal = 0
    first: Difference | None = None
    largest: Difference | None = None
    for periods, answer in enumerate(answers, start=1):
        found = list(_differences(periods - 1, *answer))
        equal += not found
        first = first or next(iter(found), None)
        largest = max([*([largest] if largest else []), *found], key=_size, default=None)
    return Comparison(episode, periods, equal, aged, first, largest)


def command_values(command: object) -> Values:
    """Return the fields of a command or of its message. Shape: (fields, 6)."""
    return np.array([getattr(command, field) for field in COMMAND_FIELDS], dtype=np.float64)


def _answers(
    recorded: Recorded, stamps: list[int], policy: Policy, cpg: CpgConfig
) -> Iterator[Answer]:
    previous = np.zeros(ACTION_SIZE, dtype=np.float32)
    for stamp in stamps:
        action = policy(recorded.observation(stamp, previous))
        told = command_values(recorded.commands.at(stamp))
        own = command_values(command_from_action(action, cpg.reading, cpg.ranges))
        yield stamp, told, own
        # What the robot was told is its previous action, whoever chose it.
        previous = action if own.tobytes() == told.tobytes() else _action(told, cpg)


def _differences(period: int, stamp: int, told: Values, own: Values) -> Iterator[Difference]:
    # Bits, so that the two zeros differ and equal means equal.
    for field, leg in np.argwhere(own.view(np.int64) != told.view(np.int64)):
        name = f'{COMMAND_FIELDS[field]} of {LEGS[leg]}'
        yield Difference(period, stamp, name, float(told[field, leg]), float(own[field, leg]))


def _size(difference: Difference) -> float:
    return difference.size


def _action(values: Values, cpg: CpgConfig) -> Action:
    """Return the action that a command of these values was made of."""
    command = Command(**dict(zip(COMMAND_FIELDS, values, strict=True)))
    return action_from_command(command, cpg.reading, cpg.ranges).clip(-1.0, 1.0)
