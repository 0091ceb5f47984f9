# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What can be otherwise about the robot, one file each; `variations.table` lists them."""
