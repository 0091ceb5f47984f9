# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Says which recorded messages are due when, at any rate, with pause, step and loop."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby

from hexapod_doe.bags.bag_file import RawMessage


@dataclass(frozen=True)
class Frame:
    """All messages of one instant."""

    time_ns: int
    messages: tuple[RawMessage, ...]


class Playback:
    """Recorded frames against a clock that the caller reads.

    Every time named `now_ns` is of that clock: steady, in nanoseconds, from any origin.
    """

    def __init__(
        self,
        read: Callable[[], Iterable[RawMessage]],
        rate: float = 1.0,
        loop: bool = False,
        paused: bool = False,
    ) -> None:
        """Begin before the first frame.

        Args:
            read: gives the messages in the order of time; called anew for each loop.
            rate: recorded seconds per second; 0 for as fast as possible.
            loop: begin again at the end.
            paused: hold until `resume` or `step`.
        """
        self.paused = paused
        self._read = read
        self._rate = rate
        self._loop = loop
        self._frames = frames(read())
        self._next = next(self._frames, None)
        # The recorded time that was, or will be, due at a time of the clock.
        self._recorded_ns = self._next.time_ns if self._next else 0
        self._anchor_ns: int | None = None

    @property
    def finished(self) -> bool:
        """Whether every frame was taken."""
        return self._next is None

    def wait_ns(self, now_ns: int) -> int | None:
        """Return in how many nanoseconds the next frame is due; 0 if it is, None if never."""
        if self._next is None or self.paused:
            return None
        if self._rate == 0.0:
            return 0
        if self._anchor_ns is None:
            self._anchor_ns = now_ns
        elapsed = (self._next.time_ns - self._recorded_ns) / self._rate
        return max(0, self._anchor_ns + round(elapsed) - now_ns)

    def take(self) -> Frame:
        """Return the next frame, due or not.

        Raises:
            ValueError: there is none.
        """
        frame = self._next
        if frame is None:
            raise ValueError('playback is finished, expected a frame that is left')
        self._next = next(self._frames, None)
        if self._next is None and self._loop:
            self._frames = frames(self._read())
            self._next = next(self._frames, None)
            # The first frame follows the last one at once.
            if self._anchor_ns is not None and self._rate:
                self._anchor_ns += round((frame.time_ns - self._recorded_ns) / self._rate)
            self._recorded_ns = self._next.time_ns if self._next else 0
        return frame

    def pause(self, now_ns: int) -> None:
        """Hold."""
        if not self.paused and self._anchor_ns is not None and self._rate:
            self._recorded_ns += round((now_ns - self._anchor_ns) * self._rate)
        self.paused = True
        self._anchor_ns = None

    def resume(self) -> None:
        """Go on from where it was held."""
        self.paused = False

    def step(self) -> Frame:
        """Take one frame while paused; what follows keeps its distance from it.

        Raises:
            ValueError: it is running, or finished.
        """
        if not self.paused:
            raise ValueError('playback is running, expected it to be paused')
        frame = self.take()
        self._recorded_ns = frame.time_ns
        return frame


def frames(messages: Iterable[RawMessage]) -> Iterator[Frame]:
    """Gather messages of the same instant."""
    for time_ns, group in groupby(messages, key=lambda message: message.time_ns):
        yield Frame(time_ns, tuple(group))
