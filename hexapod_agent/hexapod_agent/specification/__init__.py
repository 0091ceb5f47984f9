# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What decides a run, and what its agent observes."""
