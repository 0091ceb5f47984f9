# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Records of an analysis: its options and what it found, as values."""
