# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The grounds that the robot walks on, one file each; `scenes.table` lists them."""
