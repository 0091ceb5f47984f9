# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The report's figures: each one a finding, its drawing at any width, and its numbers."""
