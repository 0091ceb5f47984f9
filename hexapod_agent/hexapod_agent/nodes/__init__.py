# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The package on the graph: what imports rclpy or ROS messages."""
