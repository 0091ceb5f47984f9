# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Central pattern generator: coupled Hopf oscillators and their mapping to joint angles."""
