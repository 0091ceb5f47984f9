# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""TD3, SAC and PPO of stable-baselines3: its networks, optimisers and updates, behind our loop."""
