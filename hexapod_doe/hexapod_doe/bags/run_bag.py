# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the bag of a run says in terms of its own, beyond those of rosbag2."""

RUN_RECORD = 'hexapod_run'
"""Name of the MCAP metadata records that tell which run it is; what is written last holds."""
EPISODE_RESULT = 'hexapod_interfaces/msg/EpisodeResult'
"""Type of the one topic that every run has."""

# Values of the metadata key `status`.
RECORDING = 'recording'
"""The run goes on, or ended without saying so."""
COMPLETE = 'complete'
"""The bag holds all that it was meant to."""
SALVAGED = 'salvaged'
"""The bag is what was left of a recording that was cut."""

DIGEST = 'digest'
"""Metadata key of the fingerprint of all messages, see `digest`."""
RESUMED = 'resumed'
"""Metadata key of the number of episodes that came from an earlier recording that was cut."""
