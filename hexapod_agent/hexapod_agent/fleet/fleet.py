# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The loop of a fleet: runs take free slots, step side by side, and leave when they are done."""

import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial

from hexapod_sim.task import episode_seed

from hexapod_agent.fleet.learners import Learners
from hexapod_agent.fleet.pool import Job, Pool
from hexapod_agent.fleet.robots import Robots
from hexapod_agent.fleet.slot import Run, Slot

PARTS = ('physics', 'cpg', 'learner')


class Stopwatch:
    """Processor time by part, summed over threads: other load on the machine does not count.

    A wait for a device counts as far as the processor is kept busy with it.
    """

    def __init__(self) -> None:
        self._seconds = dict.fromkeys(PARTS, 0.0)
        self._lock = threading.Lock()
        self._began = time.process_time()

    @contextmanager
    def part(self, name: str) -> Iterator[None]:
        """Count what all threads do during the block towards one of `PARTS`."""
        began = time.process_time()
        yield
        self._add(name, time.process_time() - began)

    def timed(self, name: str, job: Callable[[], None]) -> Callable[[], None]:
        """Return the job, which counts what its own thread does towards a part."""

        def run() -> None:
            began = time.thread_time()
            job()
            self._add(name, time.thread_time() - began)

        return run

    def _add(self, name: str, seconds: float) -> None:
        with self._lock:
            self._seconds[name] += seconds

    def shares(self) -> dict[str, float]:
        """Return the share of each part in the process's time since the start, and the rest."""
        total = time.process_time() - self._began
        shares = {name: seconds / total for name, seconds in self._seconds.items()}
        return shares | {'rest': 1.0 - sum(shares.values())}


class Fleet:
    """Slots for runs that are trained in one process.

    Each run does what it does alone, in the same order: observe, act, learn, step. Only
    equal pattern generators are one batch, and with them the learners if they are a stack;
    physics and separate learners are jobs of the pool.

    Attributes:
        steps: Control periods so far, summed over the runs.
        stopwatch: Where the time went.
    """

    def __init__(self, robots: Robots, learners: Learners, pool: Pool, num_slots: int) -> None:
        self._robots, self._learners, self._pool = robots, learners, pool
        self._free = list(range(num_slots))[::-1]
        self._slots: list[Slot] = []
        self._periods = 0
        self.steps = 0
        self.stopwatch = Stopwatch()

    def train(self, take: Callable[[], Run | None]) -> None:
        """Train every run to its end.

        Args:
            take: Returns the next run, or None while there is none; asked at the start, and when
                a slot has become free.
        """
        self._admit(take)
        while self._slots:
            self._step()
            if self._close():
                self._admit(take)

    def _admit(self, take: Callable[[], Run | None]) -> None:
        """Give the free slots to the runs that come next."""
        while self._free and (run := take()) is not None:
            slot = Slot(self._free.pop(), run)
            self._learners.admit(slot)
            self._slots.append(slot)

    def _step(self) -> None:
        """Take every robot through one control period."""
        if self._periods % self._learners.update_interval == 0:
            self._begin_episodes()
        self._periods += 1
        slots = [slot for slot in self._slots if slot.steps]
        part, timed = self.stopwatch.part, self.stopwatch.timed
        with part('learner'):
            self._learners.act(slots, self._robots.actions)
        with part('cpg'):
            self._robots.command()
        with part('learner'):
            jobs = [timed('learner', job) for job in self._learners.learn(slots)]
        # The longer jobs first, so that the threads end together.
        self._pool.run([*jobs, *self._physics(slots)])
        with part('learner'):
            self._learners.collect()
        self.steps += len(slots)

    def _begin_episodes(self) -> None:
        """Let every slot that waits begin its next episode."""
        for slot in self._slots:
            if slot.waits:
                slot.waits = False
                slot.guard(partial(self._begin_episode, slot))

    def _begin_episode(self, slot: Slot) -> None:
        run_seed, episode = slot.next_episode
        seed = episode_seed(run_seed, episode)
        slot.observation, slot.outcome = self._robots.reset(slot.index, slot.config, seed)
        slot.agent.begin_episode(episode)

    def _physics(self, slots: Sequence[Slot]) -> list[Job]:
        return [self.stopwatch.timed('physics', partial(self._advance, slot)) for slot in slots]

    def _advance(self, slot: Slot) -> None:
        """Advance one robot and observe it, unless its run has failed."""

        def advance() -> None:
            slot.outcome = self._robots.advance(slot.index)
            slot.observation = self._robots.observe(slot.index, slot.trainer.spec)

        slot.guard(advance)

    def _close(self) -> bool:
        """Close the episodes that are over; return whether a slot has become free."""
        occupied = len(self._slots)
        for slot in list(self._slots):
            if slot.steps and (slot.outcome.terminated or slot.outcome.truncated):
                slot.guard(partial(self._end_episode, slot))
            if slot.fault is not None:
                slot.run.failed(slot.fault)
            elif not slot.is_done:
                continue
            else:
                slot.run.ended()
            self._slots.remove(slot)
            self._free.append(slot.index)
            self._robots.actions[slot.index] = 0.0
        return len(self._slots) < occupied

    def _end_episode(self, slot: Slot) -> None:
        """Close one run's episode; its next one, if it has one, is to begin."""
        if slot.player is None and (slot.run.saves_next or slot.is_last):
            self._learners.sync(slot)
        slot.end_episode()
        slot.waits = True
