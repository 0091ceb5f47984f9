# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""MuJoCo model of the hexapod, its sensors and the line-following task."""
