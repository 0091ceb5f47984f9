# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Designs, aliases, power and plans: which runs to make."""
