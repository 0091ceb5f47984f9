# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Entry points of the package's nodes; see `hexapod_node.executable`."""

from hexapod_node.executable import executable

manager_node = executable('hexapod_doe.nodes.manager_node')
recorder_node = executable('hexapod_doe.nodes.recorder_node')
player_node = executable('hexapod_doe.nodes.player_node')
