# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What follows from the chosen model: rank uncertainty, attribution, averaging, purchase."""

from typing import TypedDict

import numpy as np

from hexapod_doe.choosing.attribution import attribute
from hexapod_doe.choosing.averaging import average
from hexapod_doe.choosing.devices import read_devices
from hexapod_doe.choosing.draws import interval_of
from hexapod_doe.choosing.outlook import Outlook
from hexapod_doe.choosing.purchase import purchase
from hexapod_doe.choosing.ranks import rank_uncertainty
from hexapod_doe.records.findings import (
    Attribution,
    Averaging,
    Estimate,
    Purchase,
    RankUncertainty,
)
from hexapod_doe.records.options import Options
from hexapod_doe.tables.table import RunTable


class Conclusions(TypedDict):
    """Fields of the analysis that this module fills."""

    rank_uncertainty: RankUncertainty | None
    attribution: Attribution
    averaging: Averaging
    purchase: Purchase | None
    against_all: Estimate | None


def conclude(
    table: RunTable,
    outlook: Outlook,
    options: Options,
    rng: np.random.Generator,
) -> Conclusions:
    """Draw the conclusions of the model that the choice is made from.

    Raises:
        AnalysisError: The device table cannot be read, or does not yield a factor.
    """
    return Conclusions(
        rank_uncertainty=rank_uncertainty(outlook, options.level),
        attribution=attribute(table.levels, outlook.terms, outlook.coef, outlook.value, rng),
        averaging=average(
            outlook.levels,
            outlook.response,
            outlook.spread,
            options.level,
            rng,
            outlook.blocks,
            outlook.decide,
        ),
        purchase=_purchase(table, outlook, options),
        against_all=_against_all(outlook, options.level),
    )


def _against_all(outlook: Outlook, level: float) -> Estimate | None:
    """Compare the first of the ranking with the set of all factors, by the model that states."""
    stated = outlook.stated
    if stated is None:
        return None
    first, every = outlook.labels.index(outlook.ranking[0]), len(outlook.labels) - 1
    low, high = interval_of(stated.draws[:, first] - stated.draws[:, every], level)
    difference = float(stated.fits[first] - stated.fits[every])
    return Estimate(difference, (float(low), float(high)))


def _purchase(table: RunTable, outlook: Outlook, options: Options) -> Purchase | None:
    """Price the sets, if a device table is given or the default one fits the factors.

    Of other factors than sensors only those cost something that name a device.
    """
    devices, given = read_devices(options.devices), options.devices is not None
    if all(factor.is_sensor for factor in table.named):
        meant = given or set(table.factors) == devices.letters
        return purchase(outlook, devices, options.level, options.delta) if meant else None
    devices = devices.of_factors(table.named)
    needed = {factor.letter for factor in table.named if factor.device is not None}
    if not needed or not (given or needed <= devices.letters):
        return None
    free = set(table.factors) - needed
    return purchase(outlook, devices, options.level, options.delta, free)
