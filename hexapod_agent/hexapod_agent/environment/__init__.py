# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The Gymnasium environment, and episodes that a policy plays in it."""
