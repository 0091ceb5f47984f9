# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The node of the pattern generator, in lock-step and in real time, and its messages."""
