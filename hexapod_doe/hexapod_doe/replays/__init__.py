# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Recorded episodes gone through again: by another agent, or with another reward."""
