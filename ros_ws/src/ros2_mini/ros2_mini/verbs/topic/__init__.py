# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The verbs of `ros2 topic`."""
