# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Studies of the tool itself: of the learning."""
