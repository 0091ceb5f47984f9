# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A small `ros2` command for machines that have rclpy from PyPI and no ROS 2 install.

Arguments, output and exit codes are those of the Jazzy command line, as far as it goes.
"""
