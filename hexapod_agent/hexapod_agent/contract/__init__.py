# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The sensor contract: what every topic of a set must deliver, and what is wrong where it doesn't.

The checks work on decoded samples, from a live graph or a bag alike, and know no ROS.
"""
