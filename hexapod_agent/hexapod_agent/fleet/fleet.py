# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The loop of a fleet: runs take free places, step side by side, and leave when they are done."""

from collections.abc import Callable, Sequence
from functools import partial

from hexapod_sim.task import episode_seed

from hexapod_agent.fleet.crew import Crew, Job
from hexapod_agent.fleet.learners import Learners
from hexapod_agent.fleet.robots import Robots
from hexapod_agent.fleet.seat import Run, Seat
from hexapod_agent.fleet.stopwatch import Stopwatch


class Fleet:
    """Places for runs that are trained in one process.

    Each run does what it does alone, in the same order: observe, act, learn, step. Only
    equal pattern generators are one batch, and with them the learners if they are a stack;
    physics and separate learners are jobs of the crew.

    Attributes:
        steps: Control periods so far, summed over the runs.
        stopwatch: Where the time went.
    """

    def __init__(self, robots: Robots, learners: Learners, crew: Crew, places: int) -> None:
        self._robots, self._learners, self._crew = robots, learners, crew
        self._free = list(range(places))[::-1]
        self._seats: list[Seat] = []
        self._periods = 0
        self.steps = 0
        self.stopwatch = Stopwatch()

    def train(self, take: Callable[[], Run | None]) -> None:
        """Train every run to its end.

        Args:
            take: Returns the next run, or None while there is none; asked at the start, and when
                a place has become free.
        """
        self._admit(take)
        while self._seats:
            self._step()
            if self._close():
                self._admit(take)

    def _admit(self, take: Callable[[], Run | None]) -> None:
        """Give the free places to the runs that come next."""
        while self._free and (run := take()) is not None:
            seat = Seat(self._free.pop(), run)
            self._learners.seat(seat)
            self._seats.append(seat)

    def _step(self) -> None:
        """Take every robot through one control period."""
        if self._periods % self._learners.beat == 0:
            self._begin_episodes()
        self._periods += 1
        seats = [seat for seat in self._seats if seat.steps]
        part, timed = self.stopwatch.part, self.stopwatch.timed
        with part('learner'):
            self._learners.act(seats, self._robots.actions)
        with part('cpg'):
            self._robots.command()
        with part('learner'):
            jobs = [timed('learner', job) for job in self._learners.learn(seats)]
        # The longer jobs first, so that the threads end together.
        self._crew.run([*jobs, *self._physics(seats)])
        with part('learner'):
            self._learners.collect()
        self.steps += len(seats)

    def _begin_episodes(self) -> None:
        """Let every seat that waits begin its next episode."""
        for seat in self._seats:
            if seat.waits:
                seat.waits = False
                seat.attempt(partial(self._begin_episode, seat))

    def _begin_episode(self, seat: Seat) -> None:
        run_seed, episode = seat.next_episode
        seed = episode_seed(run_seed, episode)
        seat.observation, seat.outcome = self._robots.reset(seat.place, seat.trainer.config, seed)
        seat.agent.begin_episode(episode)

    def _physics(self, seats: Sequence[Seat]) -> list[Job]:
        return [self.stopwatch.timed('physics', partial(self._advance, seat)) for seat in seats]

    def _advance(self, seat: Seat) -> None:
        """Advance one robot and observe it, unless its run has failed."""

        def advance() -> None:
            seat.outcome = self._robots.advance(seat.place)
            seat.observation = self._robots.observe(seat.place, seat.trainer.spec)

        seat.attempt(advance)

    def _close(self) -> bool:
        """Close the episodes that are over; return whether a place has become free."""
        seated = len(self._seats)
        for seat in list(self._seats):
            if seat.steps and (seat.outcome.terminated or seat.outcome.truncated):
                seat.attempt(partial(self._end_episode, seat))
            if seat.fault is not None:
                seat.run.failed(seat.fault)
            elif not seat.is_done:
                continue
            else:
                seat.run.ended()
            self._seats.remove(seat)
            self._free.append(seat.place)
            self._robots.actions[seat.place] = 0.0
        return len(self._seats) < seated

    def _end_episode(self, seat: Seat) -> None:
        """Close one run's episode; its next one, if it has one, is to begin."""
        if seat.player is None and (seat.run.saves_next or seat.is_last):
            self._learners.settle(seat)
        seat.end_episode()
        seat.waits = True
