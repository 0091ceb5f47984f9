# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The nodes of the simulator and of the test double of a robot, and their messages."""
