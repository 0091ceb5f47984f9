# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Frames are due at their recorded distances over the rate, whatever is held in between."""

import pytest
from hexapod_doe.bags.bag_file import RawMessage
from hexapod_doe.bags.playback import MOST_PAUSE_NS, Frame, Jump, Playback, frames

A, B, C = (RawMessage('/a', 100, b'a'), RawMessage('/b', 100, b'b'), RawMessage('/a', 140, b'c'))
D = RawMessage('/a', 200, b'd')
MESSAGES = (A, B, C, D)


def playback(**kwargs) -> Playback:
    return Playback(lambda: MESSAGES, **kwargs)


def test_frames_gather_an_instant():
    assert list(frames(MESSAGES)) == [Frame(100, (A, B)), Frame(140, (C,)), Frame(200, (D,))]


@pytest.mark.parametrize(
    ('rate', 'due'), [(1.0, (0, 40, 100)), (2.0, (0, 20, 50)), (0.5, (0, 80, 200))]
)
def test_due_times_follow_the_rate(rate, due):
    player = playback(rate=rate)
    origin = 7_000
    for offset in due:
        # Asked at the origin, before, and after it is due.
        assert player.wait_ns(origin) == offset
        assert player.wait_ns(origin + offset + 5) == 0
        player.take()
    assert player.finished
    assert player.wait_ns(origin) is None


def test_rate_zero_is_always_due():
    player = playback(rate=0.0)
    for _ in range(3):
        assert player.wait_ns(7_000) == 0
        player.take()
    assert player.finished


def test_lateness_does_not_add_up():
    player = playback()
    assert player.wait_ns(0) == 0
    player.take()
    assert player.wait_ns(39) == 1
    player.take()  # late by 30
    assert player.wait_ns(70) == 30


def test_pause_holds_and_resume_goes_on_at_the_same_point():
    player = playback()
    assert player.wait_ns(0) == 0
    player.take()
    player.pause(15)  # 25 before the next frame
    assert player.wait_ns(1_000) is None
    player.pause(2_000)  # again: nothing
    player.resume()
    assert player.wait_ns(5_000) == 25
    assert player.wait_ns(5_025) == 0


def test_step_takes_one_instant_and_keeps_the_distance_of_the_rest():
    player = playback(paused=True)
    assert player.wait_ns(0) is None
    assert player.step() == Frame(100, (A, B))
    player.resume()
    assert player.wait_ns(900) == 40
    with pytest.raises(ValueError, match='running, expected it to be paused'):
        player.step()


def test_step_after_the_end():
    player = playback(paused=True)
    for _ in range(3):
        player.step()
    with pytest.raises(ValueError, match='finished, expected a frame that is left'):
        player.step()


def test_loop_begins_again_at_once_and_keeps_time():
    player = playback(loop=True)
    waits = []
    for _ in range(6):
        waits.append(player.wait_ns(0))
        player.take()
    # Second round: its first frame is due with the last of the first one.
    assert waits == [0, 40, 100, 100, 140, 200]
    assert not player.finished


def test_empty_bag_is_finished():
    player = Playback(tuple, loop=True)
    assert player.finished
    assert player.wait_ns(0) is None


DAY = MOST_PAUSE_NS


@pytest.mark.parametrize(
    ('times', 'text'),
    [
        ((0, 40, 40 + 365 * DAY, 90 + 365 * DAY), 'nothing was recorded for 365.0 days'),
        ((500, 540, 100, 150), 'recorded times go back by 0.0 s'),
    ],
)
def test_a_jump_of_recorded_times_is_passed_over_and_told(times, text):
    player = Playback(lambda: [RawMessage('/a', at, b'') for at in times], rate=2.0)
    jumps = []
    for due in (0, 20, 20, 45):  # what follows the jump keeps its distance
        assert player.wait_ns(0) == due
        player.take()
        jumps.append(player.jump)
    assert jumps == [None, Jump(times[1], times[2]), None, None]
    assert str(jumps[1]) == text


def test_a_jump_is_passed_over_after_steps_too():
    times = (0, 40, 40 + 2 * DAY, 90 + 2 * DAY)
    player = Playback(lambda: [RawMessage('/a', at, b'') for at in times], paused=True)
    player.step()
    player.step()
    player.resume()
    assert player.wait_ns(7) == 0
    player.take()
    assert player.wait_ns(7) == 50


def test_a_pause_of_a_day_is_kept():
    player = Playback(lambda: [RawMessage('/a', at, b'') for at in (0, DAY)])
    assert player.wait_ns(0) == 0
    player.take()
    assert player.jump is None
    assert (player.wait_ns(0), player.next_ns) == (DAY, DAY)
