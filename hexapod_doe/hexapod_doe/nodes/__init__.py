# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The nodes of campaigns and bags, and what turns their records into messages."""
