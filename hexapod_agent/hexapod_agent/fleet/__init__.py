# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Many training runs side by side in one process: robots over threads, learners in a stack."""
