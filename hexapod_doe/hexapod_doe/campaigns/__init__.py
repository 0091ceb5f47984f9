# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Campaigns: which rows are due, workers of this machine, progress."""
