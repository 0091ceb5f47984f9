# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Bags: writing, reading, checking and saving what a run recorded."""
