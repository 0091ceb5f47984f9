# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A training run: its loop's bookkeeping, checkpoints and records."""
