# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The report: one HTML page, its figures and its tables."""
