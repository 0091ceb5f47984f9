# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Tables of runs, from bags or CSV, checked and described."""
