# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Says of a playback where nothing is due for long, so that nobody takes it for the end."""

from __future__ import annotations

from hexapod_doe.bags.durations import duration_text
from hexapod_doe.bags.playback import Playback

_LONG_NS = 10_000_000_000


class PauseTeller:
    """Tells each long pause, and each jump of recorded time, once."""

    def __init__(self, playback: Playback, start_ns: int, option: str) -> None:
        """Watch a playback.

        Args:
            playback: which.
            start_ns: recorded time from which the option below counts.
            option: what begins a playback after a pause, with a place for the seconds.
        """
        self._playback = playback
        self._start_ns = start_ns
        self._option = option
        self._told_ns: int | None = None

    def notice(self, wait_ns: int | None) -> str:
        """Return what is to be told of the next frame; '' for nothing.

        Args:
            wait_ns: time until it is due; None if it never is.
        """
        next_ns, jump = self._playback.next_ns, self._playback.jump
        if next_ns is None or next_ns == self._told_ns:
            return ''
        option = self._option.format((next_ns - self._start_ns) * 1e-9)
        if jump:
            text = f'{jump}: passed over; {option} begins after it'
        elif wait_ns is not None and wait_ns > _LONG_NS:
            text = f'nothing is due for {duration_text(wait_ns)}; {option} begins after it'
        else:
            return ''
        self._told_ns = next_ns
        return text
