# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the bag of a run says in terms of its own, beyond those of rosbag2."""

from collections.abc import Mapping

from hexapod_doe.errors import BagError

RUN_RECORD = 'hexapod_run'
"""Name of the MCAP metadata records that tell which run it is; what is written last holds."""
EPISODE_RESULT = 'hexapod_interfaces/msg/EpisodeResult'
"""Type of the topic that every run has, and of the one of its evaluation."""
RESULT_TOPIC, EVALUATION_TOPIC = 'episode_result', 'evaluation_result'
"""Names of the two, below the worker's."""

# Values of the metadata key `status`.
RECORDING = 'recording'
"""The run goes on, or ended without saying so."""
COMPLETE = 'complete'
"""The bag holds all that it was meant to."""
SALVAGED = 'salvaged'
"""The bag is what was left of a recording that was cut."""

DIGEST = 'digest'
"""Metadata key of the fingerprint of all messages, see `digest`."""
EVALUATION, EVALUATION_RETURN = 'evaluation', 'evaluation_return'
"""Metadata keys: how many episodes of an evaluation a run has, and their mean return."""
_MOST_DIGITS = 7
RESUMED = 'resumed'
"""Metadata key of the number of episodes that came from an earlier recording that was cut."""


def evaluation_of(metadata: Mapping[str, str]) -> int:
    """Return how many episodes a run's evaluation has; bags of before had none.

    Raises:
        BagError: what is stated is no such number.
    """
    stated = metadata.get(EVALUATION, '0')
    if not (stated.isdecimal() and len(stated) <= _MOST_DIGITS):
        raise BagError(f'metadata key {EVALUATION} is {stated[:20]!r}, expected a number')
    return int(stated)


def is_evaluation(topic: str) -> bool:
    """Whether results on a topic are those of evaluations."""
    return topic.rsplit('/', 1)[-1] == EVALUATION_TOPIC
