# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Fits: least squares, elimination, transformation, Lenth."""
