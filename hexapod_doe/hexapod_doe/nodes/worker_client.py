# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A worker as a campaign's manager sees it: the action that it offers, and its signs of life."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from action_msgs.msg import GoalStatus
from hexapod_interfaces.action import TrainRun
from hexapod_node.coroutines import sleep

if TYPE_CHECKING:
    from hexapod_node.actions import ActionClient
    from rclpy.node import Node
    from rclpy.task import Future

_POLL_S = 0.05
_LOST_S = 5.0

OnEpisode = Callable[[int, float], None]
"""Called with number and return of each episode that ends."""


class WorkerBusyError(RuntimeError):
    """A worker has somebody else's run under way."""


class WorkerLostError(RuntimeError):
    """A worker is gone, or gives no sign of life."""


@dataclass(frozen=True)
class Ended:
    """How a worker says that a run ended; whether its bag is whole is another question."""

    succeeded: bool
    message: str
    reward: float
    """Final average reward."""


class WorkerClient:
    """One worker.

    Attributes:
        name: its namespace.
        gone: why it gets no more rows; '' while it does.
    """

    def __init__(self, node: Node, client: ActionClient, name: str, stall_s: float) -> None:
        """Begin to watch a worker.

        Args:
            node: that asks.
            client: of the worker's action.
            name: of the worker.
            stall_s: longest time without a sign of life while it has a run.
        """
        self.name = name
        self.gone = ''
        self._node = node
        self._client = client
        self._stall_s = stall_s
        self._silent_s = 0.0
        self._owing: Future | None = None  # answer of a worker that was given up
        self._seen = time.monotonic()

    def present(self) -> bool:
        """Whether the server is there; the name of an action may be that of a client alone."""
        if self._client.server_is_ready():
            self._seen = time.monotonic()
            return True
        return False

    def lost(self) -> bool:
        """Whether the server has been gone for a while."""
        return not self.present() and time.monotonic() - self._seen > _LOST_S

    @property
    def ready(self) -> bool:
        """Whether it can be given a run: it is there, and has answered what it was asked."""
        return self.present() and (self._owing is None or self._owing.done())

    async def train(
        self,
        goal: TrainRun.Goal,
        on_episode: OnEpisode,
        on_begin: Callable[[], None] = lambda: None,
    ) -> Ended:
        """Have a run trained.

        Args:
            goal: the run.
            on_episode: called whenever an episode ends.
            on_begin: called when the worker has accepted.

        Raises:
            WorkerBusyError: it refused, another run is under way there.
            WorkerLostError: it gave no sign of life for too long, or `gone` was set.
        """
        self._silent_s = 0.0
        asked = self._client.send_goal_async(goal, partial(self._on_feedback, on_episode))
        try:
            handle = await self._answer(asked)
        except WorkerLostError:
            asked.add_done_callback(self._cancel_late)
            self._owing = asked
            raise
        if not handle.accepted:
            raise WorkerBusyError(f'{self.name} has another run under way')
        on_begin()
        try:
            response = await self._answer(handle.get_result_async())
        except WorkerLostError:
            self._owing = handle.cancel_goal_async()  # read once it comes back
            raise
        result = response.result
        succeeded = response.status == GoalStatus.STATUS_SUCCEEDED
        message = result.message or ('' if succeeded else 'the run was aborted')
        return Ended(succeeded, message, result.final_average_reward)

    def close(self) -> None:
        """Stop watching."""
        self._client.destroy()

    async def _answer(self, request: Future) -> Any:
        """Wait for an answer for as long as there are signs of life.

        Silence is counted while this process is awake: after a pause of the manager itself, or a
        jump of the clock, no worker is late.
        """
        while not request.done():
            await sleep(self._node, _POLL_S)
            self._silent_s += _POLL_S
            if self.gone:
                raise WorkerLostError(f'{self.name}: {self.gone}')
            if self._silent_s > self._stall_s:
                raise WorkerLostError(f'{self.name}: no sign of life for {self._stall_s:g} s')
        return request.result()

    def _on_feedback(self, on_episode: OnEpisode, message: TrainRun.Impl.FeedbackMessage) -> None:
        self._silent_s = 0.0
        feedback = message.feedback
        if feedback.ended:
            on_episode(feedback.episode, feedback.episode_return)

    def _cancel_late(self, asked: Future) -> None:
        """Take back a goal that was accepted after it was given up."""
        if asked.exception() is None and asked.result().accepted:
            self._owing = asked.result().cancel_goal_async()
