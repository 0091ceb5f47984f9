# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Serialises the result of an episode as the graph publishes it, without a ROS process."""

from collections.abc import Callable
from functools import cache
from typing import Any

from hexapod_agent.learning.summary import EpisodeSummary
from mcap_ros2._dynamic import serialize_dynamic

from hexapod_doe.bags.run_bag import EPISODE_RESULT
from hexapod_doe.bags.schema import definition

_NANOSECONDS = 1_000_000_000
_NO_FAULTS = dict.fromkeys(('late', 'missing', 'duplicate', 'out_of_order'), 0)


def serialise(run_id: str, summary: EpisodeSummary, stamp_ns: int) -> bytes:
    """Return an EpisodeResult as a node on the graph sends it, its padding filled with zeros.

    Args:
        run_id: of the run.
        summary: of the episode; in one process, no message of it is late or lost.
        stamp_ns: simulated time of its last sample.

    Raises:
        hexapod_doe.errors.BagError: the message package is not installed.
    """
    sec, nanosec = divmod(stamp_ns, _NANOSECONDS)
    fields = dict(vars(summary))
    terms, metrics = fields.pop('terms'), fields.pop('metrics')
    header = {'stamp': {'sec': sec, 'nanosec': nanosec}, 'frame_id': ''}
    own = {
        'term_names': list(terms), 'term_values': list(terms.values()),
        'metric_names': list(metrics), 'metric_values': list(metrics.values()),
    }  # fmt: skip
    return _encoder()({'header': header, 'run_id': run_id, **fields, **own, **_NO_FAULTS})


@cache
def _encoder() -> Callable[[dict[str, Any]], bytes]:
    """Return the function that encodes the message type from its installed definition."""
    return serialize_dynamic(EPISODE_RESULT, definition(EPISODE_RESULT))[EPISODE_RESULT]
