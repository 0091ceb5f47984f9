# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Entry points of the package's nodes; see `hexapod_node.executable`."""

from hexapod_node.executable import executable

agent_node = executable('hexapod_agent.nodes.agent_node')
play_node = executable('hexapod_agent.nodes.play_node')
