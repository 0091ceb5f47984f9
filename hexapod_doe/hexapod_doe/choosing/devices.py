# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The table of purchasable devices, and the cheapest ones that yield a set of observations."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, replace
from importlib.resources import files
from itertools import combinations
from pathlib import Path
from typing import Any

import yaml
from hexapod_sim.sums import ordered_sum

from hexapod_doe.designs.factor import Factor
from hexapod_doe.errors import AnalysisError
from hexapod_doe.records.findings import Device


@dataclass(frozen=True)
class DeviceTable:
    """Devices and what counts as not worse."""

    devices: tuple[Device, ...]
    currency: str
    delta_share: float
    """Share of the best predicted reward within which a set is not worse."""
    confidence: float

    @property
    def letters(self) -> set[str]:
        """Every observation that some device yields."""
        return set(''.join(device.yields for device in self.devices))

    def of_factors(self, factors: Sequence[Factor]) -> 'DeviceTable':
        """Return the devices that some factors name: of sensors by letter, of others by name."""
        needing = [factor for factor in factors if factor.device is not None]

        def yields(device: Device) -> str:
            return ''.join(
                factor.letter
                for factor in needing
                if (factor.sensor or '?') in device.yields or factor.device == device.name
            )

        made = (replace(device, yields=yields(device)) for device in self.devices)
        return replace(self, devices=tuple(device for device in made if device.yields))

    def cheapest(self, letters: Iterable[str]) -> tuple[Device, ...]:
        """Return the cheapest devices that yield all the letters; the fewest on a tie.

        Raises:
            AnalysisError: No device yields one of the letters.
        """
        wanted = set(letters)
        if missing := sorted(wanted - self.letters):
            raise AnalysisError(
                f'no device yields {missing[0]!r}, expected one in the device table'
            )
        useful = [device for device in self.devices if wanted & set(device.yields)]
        sets = (
            chosen
            for size in range(len(useful) + 1)
            for chosen in combinations(useful, size)
            if wanted <= set(''.join(device.yields for device in chosen))
        )
        return min(sets, key=lambda chosen: (ordered_sum(d.cost for d in chosen), len(chosen)))


def read_devices(path: Path | None = None) -> DeviceTable:
    """Read a device table, by default the one of the package.

    Raises:
        AnalysisError: A key is unknown or missing, or a value is not what it should be.
        FileNotFoundError: There is no such file.
    """
    source = path or files('hexapod_doe.choosing') / 'devices.yaml'
    try:
        record = yaml.safe_load(source.read_text(encoding='utf-8'))
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise AnalysisError(f'{source}: no YAML ({error})') from error
    expected = {'currency', 'delta_share', 'confidence', 'devices'}
    if not isinstance(record, dict) or set(record) != expected:
        raise AnalysisError(f'{source}: expected the keys {", ".join(sorted(expected))}')
    if not isinstance(record['devices'], list) or not record['devices']:
        raise AnalysisError(f'{source}: expected a list of devices')
    devices = tuple(_device(entry, str(source)) for entry in record['devices'])
    share, confidence = (
        _number(record[name], f'{source}: {name}', 1.0) for name in ('delta_share', 'confidence')
    )
    return DeviceTable(devices, str(record['currency']), share, confidence)


def _number(value: Any, what: str, high: float = math.inf) -> float:
    """Return a number from 0 to a limit."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise AnalysisError(f'{what} is {value!r}, expected a number')
    if value < 0:
        raise AnalysisError(f'{what} is negative, expected a number from 0')
    if not (value <= high and math.isfinite(value)):
        raise AnalysisError(f'{what} is {value}, expected a number up to {min(high, 1e100):g}')
    return float(value)


def _device(entry: Any, source: str) -> Device:
    names = {field.name for field in fields(Device)}
    if not isinstance(entry, dict) or set(entry) != names:
        raise AnalysisError(
            f'{source}: device {entry}: expected the keys {", ".join(sorted(names))}'
        )
    numbers = {
        name: _number(
            entry[name],
            f'{source}: device {entry["name"]!r}: {name}',
            1.0 if name == 'failure_probability' else math.inf,
        )
        for name in sorted(names - {'name', 'yields'})
    }
    return Device(name=str(entry['name']), yields=str(entry['yields']), **numbers)
