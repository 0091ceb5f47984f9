# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Says which recorded messages are due when, at any rate, with pause, step and loop."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby

from hexapod_doe.bags.bag_file import RawMessage

_UNITS = (('years', 365.25 * 86400.0), ('days', 86400.0), ('hours', 3600.0), ('minutes', 60.0))
MOST_PAUSE_NS = 24 * 3600 * 1_000_000_000
_LONG_NS = 10_000_000_000


def duration_text(nanoseconds: int) -> str:
    """Return a duration in the largest unit of which it has two, such as '55.8 years'."""
    seconds = nanoseconds * 1e-9
    for name, size in _UNITS:
        if seconds >= 2.0 * size:
            return f'{seconds / size:.1f} {name}'
    return f'{seconds:.1f} s'


# No robot rests this long within a recording: clocks that were set, or stamps that were not.


@dataclass(frozen=True)
class Jump:
    """Two recorded times, one after the other, that no clock went through."""

    from_ns: int
    to_ns: int

    def __str__(self) -> str:
        if self.to_ns < self.from_ns:
            return f'recorded times go back by {duration_text(self.from_ns - self.to_ns)}'
        return f'nothing was recorded for {duration_text(self.to_ns - self.from_ns)}'


@dataclass(frozen=True)
class Frame:
    """All messages of one instant."""

    time_ns: int
    messages: tuple[RawMessage, ...]


class Playback:
    """Recorded frames against a clock that the caller reads.

    Every time named `now_ns` is of that clock: steady, in nanoseconds, from any origin.

    Attributes:
        paused: whether it is held.
        jump: how recorded time jumped before the next frame, back or by more than a day; None if
            it went on. That frame follows at once.
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
        self.jump: Jump | None = None
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

    @property
    def next_ns(self) -> int | None:
        """Recorded time of the next frame; None after the last one."""
        return self._next.time_ns if self._next else None

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
        self.jump = _jump(frame, self._next)
        again = self._next is None and self._loop
        if again:
            self._frames = frames(self._read())
            self._next = next(self._frames, None)
        if again or self.jump:
            # The next frame follows this one at once.
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
        if not self.jump:
            self._recorded_ns = frame.time_ns
        return frame


def _jump(frame: Frame, following: Frame | None) -> Jump | None:
    if following is None or 0 <= following.time_ns - frame.time_ns <= MOST_PAUSE_NS:
        return None
    return Jump(frame.time_ns, following.time_ns)


def frames(messages: Iterable[RawMessage]) -> Iterator[Frame]:
    """Gather messages of the same instant."""
    for time_ns, group in groupby(messages, key=lambda message: message.time_ns):
        yield Frame(time_ns, tuple(group))


class PauseTeller:
    """Tells each long pause, and each jump of recorded time, once."""

    def __init__(self, playback: Playback, start_ns: int) -> None:
        """Watch a playback.

        Args:
            playback: which.
            start_ns: recorded time from which the parameter `start` counts.
        """
        self._playback = playback
        self._start_ns = start_ns
        self._told_ns: int | None = None

    def notice(self, wait_ns: int | None) -> str:
        """Return what is to be told of the next frame; '' for nothing.

        Args:
            wait_ns: time until it is due; None if it never is.
        """
        next_ns, jump = self._playback.next_ns, self._playback.jump
        if next_ns is None or next_ns == self._told_ns:
            return ''
        option = f'start:={(next_ns - self._start_ns) * 1e-9:.3f}'
        if jump:
            text = f'{jump}: passed over; {option} begins after it'
        elif wait_ns is not None and wait_ns > _LONG_NS:
            text = f'nothing is due for {duration_text(wait_ns)}; {option} begins after it'
        else:
            return ''
        self._told_ns = next_ns
        return text
