# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Begins ROS in a process: what every program does once, before its first node."""

from collections.abc import Sequence

import rclpy
from rclpy.context import Context

from hexapod_node.environment import domain_id, require_log_directory
from hexapod_node.lifeline import follow_launch
from hexapod_node.participants import participants_here, warn_if_late


def begin(args: Sequence[str] | None = None, context: Context | None = None) -> None:
    """Initialise rclpy with ROS arguments, those of the command line when None.

    Args:
        args: ROS arguments.
        context: one of the caller's own, which no signal ends; None for that of the process.
    """
    follow_launch()
    require_log_directory()
    warn_if_late(participants_here(domain_id()))
    rclpy.init(args=list(args) if args is not None else None, context=context)
