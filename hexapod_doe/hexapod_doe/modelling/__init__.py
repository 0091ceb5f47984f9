# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Selection of models: which terms and which transformation, step by step."""
