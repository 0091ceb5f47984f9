# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How good a sensor is: six numbers for each channel, all zero for a perfect one."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from functools import lru_cache
from importlib.resources import files
from types import MappingProxyType
from typing import Annotated, Literal

import yaml
from annotated_types import Interval
from pydantic import ConfigDict, TypeAdapter, ValidationError

from hexapod_sim.article import section
from hexapod_sim.channel import Channel
from hexapod_sim.sensor_table import SENSORS

# What the values may be, least and greatest.
_Error = Annotated[float, Interval(ge=0.0, le=1e3)]
_Delay = Annotated[float, Interval(ge=0.0, le=10.0)]
_Chance = Annotated[float, Interval(ge=0.0, le=0.999)]
_Rate = Annotated[float, Interval(ge=0.0, le=1e3)]
# A unit quaternion has a number of at least this size, so that its rounding is not zero.
_COARSEST_ORIENTATION = 0.5


@dataclass(frozen=True)
class Quality:
    """Errors of a channel's device, in the unit of its first field.

    Of an orientation, noise and bias are rotations about the body's axes, in rad. A further
    observed field has errors in the proportion of its scale to the first one's: joint velocities
    have 6.2 rad/s of noise for each rad of the angles'.
    """

    __pydantic_config__ = ConfigDict(extra='forbid')

    noise: _Error
    """Standard deviation of each sample, contacts: chance to be wrong [unit of the channel]."""
    bias: _Error
    """Standard deviation of the constant error, drawn for an episode [unit of the channel]."""
    delay: _Delay
    """From measurement to delivery, up to the next control period [s]."""
    dropout: _Chance
    """Chance of a sample to be lost."""
    quantisation: _Error
    """Distance of the values that the device can give; 0 for any [unit of the channel]."""
    rate: _Rate
    """Samples per second; 0 for one in every control period [Hz]."""

    @property
    def perfect(self) -> bool:
        """Whether readings pass unchanged."""
        return not any(vars(self).values())


Grade = Literal['perfect', 'consumer', 'industrial']
"""Devices of a kind; sensor_quality.yaml has their numbers."""
Qualities = Mapping[str, Quality]
"""By key of the sensor table; a channel that is missing is perfect."""
PERFECT = Quality(**section('sensors', 'each'))
_QUALITIES: TypeAdapter[dict[str, Quality]] = TypeAdapter(dict[str, Quality])


@lru_cache(maxsize=1)
def grades() -> Mapping[str, dict[str, Quality]]:
    """Return the qualities of every channel by grade, from sensor_quality.yaml and perfect."""
    text = (files('hexapod_sim') / 'sensor_quality.yaml').read_text(encoding='utf-8')
    given = {'perfect': {}} | yaml.safe_load(text)
    perfect = dict.fromkeys(SENSORS, PERFECT)
    return MappingProxyType(
        {
            grade: perfect | {key: replace(PERFECT, **values) for key, values in channels.items()}
            for grade, channels in given.items()
        }
    )


def check(qualities: Qualities) -> None:
    """Refuse what no device of a channel can be.

    Raises:
        ValueError: The text names the key, and what is expected.
    """
    for key, quality in qualities.items():
        if key not in SENSORS:
            raise ValueError(f'unknown channel {key!r}, expected one of {", ".join(SENSORS)}')
        for name, greatest in _limits(SENSORS[key]).items():
            if (found := getattr(quality, name)) > greatest:
                raise ValueError(
                    f'sensors.{key}.{name} is {found}, expected at most {greatest} for '
                    f'{SENSORS[key].name}'
                )


def to_text(qualities: Qualities) -> str:
    """Return YAML of what is not perfect, as `from_text` takes it."""
    return yaml.safe_dump(
        {
            key: {name: value for name, value in asdict(quality).items() if value}
            for key, quality in qualities.items()
            if not quality.perfect
        }
    )


def from_text(text: str) -> dict[str, Quality]:
    """Read qualities by channel; what is not named is perfect.

    Raises:
        ValueError: It is not YAML, or names something unknown or out of range.
    """
    try:
        given = yaml.safe_load(text) or {}
        values = {key: asdict(PERFECT) | changes for key, changes in given.items()}
        qualities = _QUALITIES.validate_python(values)
    except ValidationError as error:
        first = error.errors()[0]
        key = '.'.join(map(str, first['loc']))
        raise ValueError(f'sensors.{key} is {first["input"]!r}: {first["msg"]}') from error
    except (yaml.YAMLError, AttributeError, TypeError) as error:
        raise ValueError(f'sensors: expected {{channel: {{key: value}}}}: {error}') from error
    check(qualities)
    return qualities


def _limits(channel: Channel) -> dict[str, float]:
    """Return the greatest values of a channel that has narrower ones than any."""
    kind = channel.observed[0].kind
    if kind == 'switch':
        return {'noise': 1.0, 'bias': 0.0, 'quantisation': 0.0}
    return {'quantisation': _COARSEST_ORIENTATION} if kind == 'quaternion' else {}
