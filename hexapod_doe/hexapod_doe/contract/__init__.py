# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Room of `check_sensors`: its options, evidence from bags, and the table that it prints."""
