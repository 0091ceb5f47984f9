# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The article's DDPG with written-out gradients, for a stack of agents."""
