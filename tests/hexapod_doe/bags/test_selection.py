# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What is played is what its subscribers will understand; all else is named, and left out."""

from __future__ import annotations

from pathlib import Path

import pytest
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.decoding import is_cdr
from hexapod_doe.bags.selection import Selection, select
from hexapod_doe.errors import BagError

from .conftest import HELLO, STRING, Recorded

CASES = Path(__file__).resolve().parents[2] / 'data/cases'
EIGHT = 8
"""Topics of the small bags, with 40 messages each as a rule."""


def importable(type_name: str) -> None:
    """Stand in for the import of a message class: everything is installed."""


def selected(bag: Path) -> Selection:
    file = BagFile(bag)
    return select(file, list(file.types), importable)


@pytest.mark.parametrize(
    ('case', 'messages', 'refused'),
    [
        ('plain_ok', 320, []),
        ('b01_write_split', 320, ['/events/write_split', '/arm/set_mode/_service_event']),
        ('b02_file_zstd', 320, []),
        ('b03_message_zstd', 64, []),
        ('b05_two_robots', 288, []),
        ('b06_idl', 320, ['/control/lateral']),
        ('b07_time_zero', 320, []),
        ('b13_humble_range', 280, ['/hexapod/body/height']),
    ],
)
def test_bags_of_other_makers(case: str, messages: int, refused: list[str]) -> None:
    found = selected(CASES / case)
    played = list(found.messages())
    assert len(played) == messages
    assert all(is_cdr(message.data) for message in played)
    assert list(found.refused) == refused
    assert len(found.warnings()) == len(refused)
    assert not found.skipped


def test_messages_that_were_compressed_one_by_one_come_as_they_were_sent() -> None:
    """Both bags hold the same walk; one of them was compressed message by message."""
    packed = list(selected(CASES / 'b03_message_zstd').messages())
    plain = list(selected(CASES / 'plain_ok').messages())
    assert packed == plain[: len(packed)]
    assert list(selected(CASES / 'b02_file_zstd').messages()) == plain


def test_the_field_that_differs_is_named() -> None:
    (warning,) = selected(CASES / 'b13_humble_range').warnings()
    assert warning == (
        '/hexapod/body/height is not played: sensor_msgs/Range has no further field in the bag, '
        "'float32 variance' here"
    )


def test_bytes_that_are_no_message_are_left_out_and_counted(foreign) -> None:
    lz4 = b'\x04\x22\x4d\x18' + bytes(20)
    messages = [(1, HELLO), (2, b''), (3, lz4), (4, HELLO), (5, b'\0\1')]
    found = selected(foreign(Recorded(messages=messages)))
    assert [message.time_ns for message in found.messages()] == [1, 4]
    assert found.skipped == {'/chatter': 3}


def test_a_topic_of_two_types_is_neither(foreign) -> None:
    two = Recorded(type_name='std_msgs/msg/Int8', definition=b'int8 data', messages=())
    bag = foreign(Recorded(), two, Recorded('/other'))
    found = selected(bag)
    assert found.topics == ['/other']
    assert 'std_msgs/msg/Int8 and std_msgs/msg/String' in found.refused['/chatter']
    with pytest.raises(BagError, match=r'types .*Int8 and .*String, expected one'):
        next(BagFile(bag).decoded('/chatter'))


def test_a_name_alone_is_taken_with_a_word(foreign) -> None:
    found = selected(foreign(Recorded(definition=b'')))
    assert found.topics == ['/chatter']
    assert found.warnings() == [
        f'/chatter has no definition in the bag: taken for {STRING} as it is installed'
    ]


def test_a_bag_without_a_summary_is_chosen_from_too(foreign) -> None:
    other = Recorded('/odd', definition=b'string name')
    found = selected(foreign(Recorded(), other, indexed=False))
    assert found.topics == ['/chatter']
    assert list(found.refused) == ['/odd']


def test_a_bag_of_which_nothing_can_be_played_says_so(foreign) -> None:
    with pytest.raises(BagError, match="no topic can be played; /chatter: its messages are in ''"):
        selected(foreign(Recorded(encoding='')))


def test_a_class_that_cannot_be_imported_is_a_reason() -> None:
    def missing(type_name: str) -> None:
        if 'Imu' in type_name:
            raise ValueError(f'{type_name} has no class')

    file = BagFile(CASES / 'plain_ok')
    found = select(file, list(file.types), missing)
    assert len(found.topics) == EIGHT - 2
    assert set(found.refused.values()) == {'sensor_msgs/msg/Imu has no class'}


def test_a_name_that_ros_has_not_is_left_out(foreign) -> None:
    found = selected(
        foreign(Recorded(), Recorded('/top camera'), Recorded('/2d'), Recorded('a/b'))
    )
    assert found.topics == ['/chatter', 'a/b']
    assert list(found.refused) == ['/top camera', '/2d']


def test_a_short_name_of_a_type_is_the_same_type(foreign) -> None:
    bag = foreign(Recorded(type_name='std_msgs/String'))
    assert selected(bag).topics == ['/chatter']
    assert BagFile(bag).types_of('/chatter') == [STRING]
