# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Entry points of the package's nodes; see `hexapod_node.executable`."""

from hexapod_node.executable import executable

description_node = executable('hexapod_bringup.description_node')
watch = executable('hexapod_bringup.watch')
worker_node = executable('hexapod_bringup.worker_node')
