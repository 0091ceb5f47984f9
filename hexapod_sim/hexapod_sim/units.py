# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Units that drivers publish instead of ours."""

import math

from hexapod_sim.robot import GRAVITY

OTHER_UNITS: dict[str, tuple[tuple[str, float], ...]] = {
    'rad': (('degrees', 180.0 / math.pi),),
    'rad/s': (('degrees/s', 180.0 / math.pi), ('rpm', 30.0 / math.pi)),
    'N·m': (('kgf·cm', 100.0 / GRAVITY), ('N·cm', 100.0), ('N·mm', 1000.0)),
    'm/s': (('cm/s', 100.0), ('mm/s', 1000.0)),
    'm': (('cm', 100.0), ('mm', 1000.0)),
    'm/s²': (('g', 1.0 / GRAVITY), ('cm/s²', 100.0), ('mg', 1000.0 / GRAVITY)),
    'N': (('kgf', 1.0 / GRAVITY), ('gf', 1000.0 / GRAVITY), ('mN', 1000.0)),
    '1': (('percent', 100.0),),
}
"""By our unit: names, and how many of each make one of ours. A unit may be missing."""
