# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How a robot follows a line that jumps: the step responses of an episode that a bag holds."""

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.run_record import read_topic
from hexapod_doe.errors import BagError
from hexapod_doe.replays.episodes import LINE_OFFSET, ODOMETRY
from hexapod_doe.replays.rescoring import recorded_config

BAND = 0.1
"""Distance from the line within which the robot has settled [m]."""
CHECK_S = 10.0
"""Time after a jump at which the offset is told [s]."""
_LEAST_JUMP = 1e-6  # m; where the line is comes from two rounded numbers

Series = NDArray[np.float64]


@dataclass(frozen=True)
class Track:
    """Where robot and line were, a row per control period.

    Attributes:
        time: Since the first sample (n,), s.
        x: Way along the line (n,), m.
        y: Position across it, positive to the left (n,), m.
        line: Where the line ran (n,), m.
    """

    time: Series
    x: Series
    y: Series
    line: Series

    @property
    def offset(self) -> Series:
        """Distance from the line (n,), m, positive to its left."""
        return self.y - self.line


@dataclass(frozen=True)
class Response:
    """What followed one jump of the line, until the next.

    Attributes:
        time: When it jumped, s.
        jump: How far, m, positive to the left.
        settling_time: From the jump until the offset stays below `BAND`, s; NaN if it never does.
        overshoot: Greatest distance past the line, m.
        offset_after: |offset| `CHECK_S` after the jump, m; NaN if it jumped again before.
    """

    time: float
    jump: float
    settling_time: float
    overshoot: float
    offset_after: float


def read_track(bag: str | Path) -> Track:
    """Read a run's one recorded episode.

    Raises:
        BagError: the bag cannot be read, its topics odom and line_offset do not agree in time, or
            the latter has errors.
    """
    if not recorded_config(BagFile(bag)).sensors['line_offset'].perfect:
        raise BagError(
            f'bag {bag}: line_offset has the errors of its sensors.line_offset, expected a '
            'perfect one to find the line by'
        )
    positions = {time: m.pose.pose.position for time, m in read_topic(bag, 'odom', ODOMETRY)}
    offsets = {time: m.offset for time, m in read_topic(bag, 'line_offset', LINE_OFFSET)}
    if not positions or positions.keys() != offsets.keys():
        raise BagError(
            f'bag {bag}: {len(positions)} samples of odom and {len(offsets)} of line_offset, '
            'expected a pair of each control period'
        )
    times = sorted(positions)
    x, y = np.array([(positions[time].x, positions[time].y) for time in times]).T
    offset = np.array([offsets[time] for time in times])
    return Track((np.array(times) - times[0]) * 1e-9, x, y, y - offset)


def responses(track: Track) -> list[Response]:
    """Measure each jump of the line; one in the last sample has nothing that follows it."""
    jumps = np.flatnonzero(np.abs(np.diff(track.line)) > _LEAST_JUMP) + 1
    return [
        step_response(
            track.time[jump:end], track.offset[jump:end], track.line[jump] - track.line[jump - 1]
        )
        for jump, end in pairwise([*jumps, track.time.size])
        if end - jump > 1
    ]


def step_response(time: Series, offset: Series, jump: float) -> Response:
    """Measure one step response.

    Args:
        time: From the jump on (n,), s.
        offset: Offset from the line as it now runs (n,), m.
        jump: How far it jumped, m.
    """
    elapsed = time - time[0]
    outside = np.flatnonzero(np.abs(offset) >= BAND)
    settled = int(outside[-1]) + 1 if outside.size else 0
    after = np.flatnonzero(elapsed >= CHECK_S - 1e-9)
    return Response(
        time=float(time[0]),
        jump=float(jump),
        settling_time=float(elapsed[settled]) if settled < elapsed.size else float('nan'),
        # The robot comes from the side that the line left: past it, offset and jump agree in sign.
        overshoot=float(max(0.0, np.max(offset * np.sign(jump)))),
        offset_after=float(abs(offset[after[0]])) if after.size else float('nan'),
    )
