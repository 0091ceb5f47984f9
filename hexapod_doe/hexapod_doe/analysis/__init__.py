# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The analysis of a campaign as a whole, its description and its JSON."""
