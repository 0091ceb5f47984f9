# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a report calls its factors: sensors that a set holds, or settings with two values."""

from collections.abc import Mapping
from dataclasses import dataclass

from hexapod_doe.records.results import DesignSummary
from hexapod_doe.reporting.formats import listing


@dataclass(frozen=True)
class Words:
    """Words for one kind of factors."""

    noun: str
    set: str
    sets: str
    whole: str
    """The set with every factor at its high level."""
    none: str
    """The set with every factor at its low level."""
    empty: str
    """The same, beside names of sets."""
    low: str
    """Heading of what is at the low level."""
    high: str
    at_low: str
    """Of one factor, in a sentence."""
    at_high: str
    legend: tuple[str, str]
    """Of hollow and of filled marks."""
    interaction: str
    """What a panel of two factors shows."""
    held: str
    """What the letters of a set stand for."""
    sets_hold: str
    question: str
    """What a report on few data does not answer."""


SENSORS = Words(
    noun='sensor',
    set='set of sensors',
    sets='sets of sensors',
    whole='all sensors',
    none='no optional sensor',
    empty='none of them',
    low='without',
    high='with',
    at_low='without a sensor',
    at_high='with it',
    legend=('without the sensor', 'with it'),
    interaction=(
        'Fitted mean without and with the first sensor, once without (hollow) and once with '
        '(filled) the second one. Parallel lines mean that the sensors act independently.'
    ),
    held='its sensors',
    sets_hold='sensors the best predicted sets hold',
    question='which sensors to buy',
)
FACTORS = Words(
    noun='factor',
    set='combination of levels',
    sets='combinations of levels',
    whole='all factors high',
    none='all factors low',
    empty='all factors low',
    low='low',
    high='high',
    at_low='at the low level of a factor',
    at_high='at its high level',
    legend=('low level', 'high level'),
    interaction=(
        'Fitted mean at both levels of the first factor, once at the low (hollow) and once at '
        'the high level (filled) of the second one. Parallel lines mean that the factors act '
        'independently.'
    ),
    held='its factors at the high level',
    sets_hold='factors the best predicted sets have at their high level',
    question='which levels to choose',
)


def words(design: DesignSummary) -> Words:
    """Return the words for the factors of a design."""
    return SENSORS if design.sensors else FACTORS


def factor_text(design: DesignSummary, letter: str) -> str:
    """Return what a factor is: 'C body orientation', or 'H yaw share 0 → 1'."""
    factor = next((each for each in design.named if each.letter == letter), None)
    if factor is None:
        return letter
    return f'{letter} {factor.name if design.sensors else factor.change}'


def level_text(design: DesignSummary, letter: str, level: float) -> str:
    """Return one level of a factor, such as 'with C', 'no C' or 'yaw share 1'."""
    factor = next((each for each in design.named if each.letter == letter), None)
    if factor is None or design.sensors:
        return f'with {letter}' if level > 0 else f'no {letter}'
    return factor.text(level)


def set_text(design: DesignSummary, levels: Mapping[str, float]) -> str:
    """Return a set in words: the names of its sensors, or every factor with its level."""
    if design.named and not design.sensors:
        texts = [level_text(design, letter, level) for letter, level in levels.items()]
    else:
        names = design.factor_names
        texts = [names.get(letter, letter) for letter, level in levels.items() if level > 0]
    return listing(texts, limit=len(texts))
