# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How many participants of a ROS domain run on this host, and from when that is too many.

With LOCALHOST discovery rmw_fastrtps announces a participant to the first 32 ports of the host,
and to nobody else: the first 32 know everybody, and each later one knows them and itself.
"""

import os
import sys
from pathlib import Path

from hexapod_node.environment import domain_id

REACHED = 32
"""How many participants of a host all others find with LOCALHOST discovery."""
_PORTS = Path('/proc/net/udp')


def participants_here(domain: int, table: Path = _PORTS) -> int:
    """Return how many participants of a domain run on this host.

    Each holds the UDP port 7400 + 250 domain + 10 + 2 i for some i below 120 (RTPS 2.2, section
    9.6.1.1). The answer is 0 where the system does not list its ports.
    """
    first = 7400 + 250 * domain + 10
    ports = set(range(first, first + 240, 2))
    if not table.exists():
        return 0
    rows = [line.split() for line in table.read_text().splitlines()[1:]]
    return len(ports & {int(row[1].rpartition(':')[2], 16) for row in rows})


def warn_if_late(others: int) -> None:
    """Tell on standard error if a participant that begins after so many others finds not all."""
    if others >= REACHED and os.environ.get('ROS_AUTOMATIC_DISCOVERY_RANGE') == 'LOCALHOST':
        print(
            f'participant {others + 1} of ROS domain {domain_id()} on this host: with LOCALHOST '
            f'discovery it finds the first {REACHED} alone, expected composed workers, another '
            'ROS_DOMAIN_ID, or ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET',
            file=sys.stderr,
        )
