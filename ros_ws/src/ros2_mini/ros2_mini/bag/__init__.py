# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Read bags: directories of a `metadata.yaml` and MCAP files, as rosbag2 writes them."""
