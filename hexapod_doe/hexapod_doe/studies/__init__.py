# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Simulation studies of the analysis itself."""
