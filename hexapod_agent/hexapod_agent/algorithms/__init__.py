# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What learns: each algorithm is one entry of a table."""
