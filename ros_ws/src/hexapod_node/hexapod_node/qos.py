# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The quality-of-service profiles of the graph."""

from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

# Lock-step loses nothing. A reliable publisher also serves a best-effort subscriber. The depth is
# for the recorder, which nobody waits for: at 10, a publisher under load has overwritten samples
# that the recorder had yet to acknowledge.
LOCK_STEP = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    depth=1000,
)

# A late joiner gets the last value; both ends must ask for it.
LATCHED = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    history=HistoryPolicy.KEEP_LAST,
    depth=1,
)

# In real time drivers of any kind match, and what was lost is not sent again.
DRIVER = QoSProfile(
    reliability=ReliabilityPolicy.BEST_EFFORT,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    depth=10,
)

# What a driver hears in real time, reliable or not; nobody gets an old command.
COMMAND = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    depth=1,
)
