# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""DDPG agent that observes a chosen set of sensors, its Gymnasium environment and its training."""

import gymnasium

gymnasium.register(id='HexapodLine-v0', entry_point='hexapod_agent.environment.env:HexapodLine')
gymnasium.register(id='HexapodGraph-v0', entry_point='hexapod_agent.nodes.graph_env:HexapodGraph')
