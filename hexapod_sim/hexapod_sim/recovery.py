# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""When a robot that varies from the one that was built counts as walking again."""

from hexapod_sim.robot import CONTROL_PERIOD_NS

LATE_STEPS = round(8e9 / CONTROL_PERIOD_NS)
"""Control periods at the end of an episode in which it is judged: 8 s."""
_SHARE = 0.5


def has_recovered(fell: bool, late_speed: float, undamaged_speed: float) -> bool:
    """Return whether a varied robot walks again.

    Args:
        fell: Whether its episode ended by a failure.
        late_speed: Its speed along the line in the last 8 s, m/s.
        undamaged_speed: Mean of the same, of the same agent with the robot as it was built and
            from the same starts, m/s.
    """
    return not fell and late_speed >= _SHARE * undamaged_speed
