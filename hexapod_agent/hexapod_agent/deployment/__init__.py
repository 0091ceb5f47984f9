# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Policies that act, apart from the run that trained them."""
