# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Equal runs have equal digests; any change of a message changes them."""

import pytest
from hexapod_doe.bags.bag_writer import BagWriter
from hexapod_doe.bags.rosbag2 import Topic
from hexapod_doe.bags.verify import digest


@pytest.fixture
def digest_of(tmp_path):
    """Return a function from messages (topic, data, time) to the digest of their bag."""
    count = iter(range(100))

    def make(messages, namespace='/w0', **metadata: str) -> str:
        bag = tmp_path / f'b{next(count)}'
        with BagWriter(bag, metadata) as writer:
            for topic in ('imu/data', 'imu/raw', 'twist'):
                writer.add_topic(Topic(f'{namespace}/{topic}', 'sensor_msgs/msg/Imu'))
            for topic, data, time_ns in messages:
                writer.write(f'{namespace}/{topic}', data, time_ns)
        return digest(bag)

    return make


MESSAGES = (('imu/data', b'a', 1), ('twist', b'b', 1), ('twist', b'c', 2))


def test_order_of_arrival_worker_and_metadata_do_not_count(digest_of):
    first = digest_of(MESSAGES, began='today')
    assert digest_of([MESSAGES[1], MESSAGES[2], MESSAGES[0]], '/w1', began='tomorrow') == first
    assert digest_of(MESSAGES, '/far/away/w7') == first


@pytest.mark.parametrize(
    'changed',
    [
        MESSAGES[:2],
        (*MESSAGES, MESSAGES[2]),
        (*MESSAGES[:2], ('twist', b'd', 2)),
        (*MESSAGES[:2], ('twist', b'c', 3)),
        (*MESSAGES[:2], ('imu/data', b'c', 2)),
    ],
)
def test_every_message_counts(digest_of, changed):
    assert digest_of(changed) != digest_of(MESSAGES)
