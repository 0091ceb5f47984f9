# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What every rclpy node of the hexapod shares.

Parameters from a table, quality of service, stamps, lock-step, coroutines, diagnostics, spinning.
"""

from hexapod_node.environment import require_variables

require_variables()  # before rclpy is loaded, which ends the process and names no variable
