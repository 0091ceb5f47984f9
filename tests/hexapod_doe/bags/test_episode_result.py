# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""An episode's result that is serialised without ROS is the message that ROS sends."""

import math
from array import array

import pytest
from hexapod_agent.learning.summary import EpisodeSummary
from hexapod_doe.bags.decoding import stamp_ns
from hexapod_doe.bags.episode_result import serialise


# Lengths of text move what follows to its alignment: every remainder by eight is tried.
@pytest.mark.parametrize('length', range(1, 9))
@pytest.mark.parametrize('terms', [{}, {'velocity': 0.25, 'alive': -600.0}])
def test_ros_reads_what_it_would_have_sent(length, terms):
    from hexapod_interfaces.msg import EpisodeResult
    from rclpy.serialization import deserialize_message, serialize_message

    summary = EpisodeSummary(
        episode=7, steps=600, episode_return=1 / 3, average_return=-2.5, terms=terms,
        terminated=True, cause='x' * length, metrics={'critic_loss': math.nan, 'mean_q': 530.0},
    )  # fmt: skip
    fields = dict(vars(summary))
    for one in ('term', 'metric'):
        values = fields.pop(f'{one}s')
        fields |= {f'{one}_names': list(values), f'{one}_values': array('d', values.values())}
    message = EpisodeResult(run_id='r' * length, **fields)
    message.header.stamp.sec, message.header.stamp.nanosec = 15, 25_000_000
    data = serialise('r' * length, summary, 15_025_000_000)
    # Not byte for byte: CDR leaves the padding to chance, and rclpy does not fill it.
    assert str(deserialize_message(data, EpisodeResult)) == str(message)
    assert len(data) == len(serialize_message(message))
    assert stamp_ns(data) == 15_025_000_000
