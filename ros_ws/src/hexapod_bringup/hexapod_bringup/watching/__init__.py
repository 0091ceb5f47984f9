# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The watch page without ROS: what was heard, pictures of the robot, and the page's server."""
