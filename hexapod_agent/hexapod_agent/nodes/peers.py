# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The services of the other nodes of a worker, as the agent uses them."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from diagnostic_msgs.msg import KeyValue
from hexapod_interfaces.srv import (
    FinishRecording,
    RecordEpisode,
    ResetEpisode,
    SecureRecording,
    StartRecording,
)
from hexapod_node.coroutines import ServiceUnavailableError, call, sleep, until_true
from hexapod_node.matching import SubscriptionCounter, count_subscriber_nodes, unmatched
from hexapod_node.parameters import to_messages
from hexapod_node.stamps import time_message, to_nanoseconds
from rcl_interfaces.srv import ListParameters, SetParametersAtomically

from hexapod_agent.specification.run_spec import RunSpec
from hexapod_sim import quality

if TYPE_CHECKING:
    from rclpy.node import Node

_RETRY_S = 0.02
_ANSWER_S = 1.0


class PeerError(RuntimeError):
    """Another node of the worker refused; the text names it and gives its reason."""


class Peers:
    """Clients of `sim`, `cpg` and `recorder`, by relative names that can be remapped."""

    def __init__(self, node: Node, timeout_s: float) -> None:
        self._node = node
        self._timeout_s = timeout_s
        self._reset = {
            peer: node.create_client(ResetEpisode, f'{peer}/reset') for peer in ('sim', 'cpg')
        }
        self._start = node.create_client(StartRecording, 'recorder/start')
        self._episode = node.create_client(RecordEpisode, 'recorder/episode')
        self._secure = node.create_client(SecureRecording, 'recorder/secure')
        self._finish = node.create_client(FinishRecording, 'recorder/finish')
        # The last clients, and the first to be used: peers get to know an agent's clients in the
        # order of their making, so one answer from a peer tells that its other answers arrive.
        self._configure = {
            peer: node.create_client(SetParametersAtomically, f'{peer}/set_parameters_atomically')
            for peer in ('sim', 'cpg')
        }
        self._greet = node.create_client(ListParameters, 'recorder/list_parameters')

    async def configure(self, peer: str, prefix: str, config: Mapping[str, Any]) -> None:
        """Give a peer the configuration of the run, as its parameters."""
        request = SetParametersAtomically.Request(parameters=to_messages(prefix, config))
        client = self._configure[peer]
        response = await self._repeat_until_answered(client, request)
        if not response.result.successful:
            raise PeerError(f'{client.service_name}: {response.result.reason}')

    async def configure_run(self, spec: RunSpec) -> None:
        """Give sim and pattern generator what a run's specification says of them."""
        await self.configure('sim', 'task', asdict(spec.task))
        await self.configure('sim', 'scene', asdict(spec.scene))
        await self.configure_robot(spec)
        qualities = {'qualities': quality.to_text(spec.sensors)}
        await self.configure('sim', 'sensors', qualities)
        await self.configure('cpg', 'cpg', asdict(spec.cpg.hopf))

    async def configure_robot(self, spec: RunSpec) -> None:
        """Give the sim the variations of the robot alone."""
        await self.configure('sim', 'robot', asdict(spec.robot))

    async def greet_recorder(self) -> None:
        """Wait until the recorder's answers arrive."""
        await self._repeat_until_answered(self._greet, ListParameters.Request())

    async def begin_episode(
        self, seed: int, listeners: Callable[[], Mapping[str, int]], not_before_ns: int = 0
    ) -> int:
        """Reset sim and pattern generator; return the stamp of the first period, ns.

        Args:
            seed: The episode's.
            listeners: Tells the least number of subscriptions by fully qualified topic, now.
            not_before_ns: The first period is no earlier.
        """
        request = ResetEpisode.Request(seed=seed, start=time_message(not_before_ns))
        response = await self._reset_when_matched('sim', request, listeners)
        request.start = response.start
        await self._reset_when_matched('cpg', request, listeners)
        return to_nanoseconds(response.start)

    async def start_recording(
        self,
        run_id: str,
        bag: str,
        topics: Sequence[str],
        metadata: Mapping[str, str],
        takeover: bool = False,
        keep: int = 0,
    ) -> tuple[int, int]:
        """Open the run's bag, with so many episodes of an earlier recording or with none.

        Returns:
            How many were kept, and the stamp at their end, ns.
        """
        request = StartRecording.Request(
            run_id=run_id,
            bag=bag,
            topics=list(topics),
            metadata=key_values(metadata),
            takeover=takeover,
            keep=keep,
        )
        response = await self._ask_the_disk(self._start, request)
        return int(response.kept), to_nanoseconds(response.last)

    async def secure_recording(self, episodes: int) -> None:
        """Wait until the results of the first episodes are on the disk."""
        await self._ask_the_disk(self._secure, SecureRecording.Request(episodes=episodes))

    async def record_episode(self, episode: int, enable: bool, last_ns: int = 0) -> None:
        """Begin or end recording every topic."""
        request = RecordEpisode.Request(episode=episode, enable=enable, last=time_message(last_ns))
        await self._ask(self._episode, request)

    async def finish_recording(self, episodes: int, metadata: Mapping[str, str]) -> str:
        """Close the run's bag and return where it is."""
        request = FinishRecording.Request(episodes=episodes, metadata=key_values(metadata))
        response = await self._ask_the_disk(self._finish, request)
        return str(response.bag)

    async def _reset_when_matched(
        self,
        peer: str,
        request: ResetEpisode.Request,
        listeners: Callable[[], Mapping[str, int]],
    ) -> Any:
        """Repeat the reset until the peer's topics are matched."""
        deadline = time.monotonic() + self._timeout_s
        while True:
            wanted = listeners()
            request.topics = list(wanted)
            request.subscriptions = list(wanted.values())
            response = await call(self._node, self._reset[peer], request, self._timeout_s)
            if response.success:
                return response
            if time.monotonic() > deadline:
                raise PeerError(f'{self._reset[peer].service_name}: {response.message}')
            await sleep(self._node, _RETRY_S)

    async def _repeat_until_answered(self, client: Any, request: Any) -> Any:
        """Ask again where a server has just appeared and its answer found no way back yet."""
        deadline = time.monotonic() + self._timeout_s
        while True:
            left = deadline - time.monotonic()
            try:
                return await call(self._node, client, request, min(_ANSWER_S, left))
            except ServiceUnavailableError as error:
                if left < _ANSWER_S:
                    raise PeerError(
                        f'{client.service_name}: no answer after {self._timeout_s:g} s, expected '
                        f'a running node'
                    ) from error

    async def _ask_the_disk(self, client: Any, request: Any) -> Any:
        """Ask for what takes longer the larger a bag is; wait while the server is there."""
        answer = client.call_async(request)
        while not await until_true(self._node, answer.done, self._timeout_s):
            if not client.service_is_ready():
                client.remove_pending_request(answer)
                raise PeerError(
                    f'{client.service_name}: no answer within {self._timeout_s:g} s, expected a '
                    'running node'
                )
        return _succeeded(client, answer.result())

    async def _ask(self, client: Any, request: Any) -> Any:
        response = await call(self._node, client, request, self._timeout_s)
        return _succeeded(client, response)


async def until_heard(
    node: Node,
    publishers: Sequence[SubscriptionCounter],
    listeners: Callable[[], Mapping[str, int]],
    timeout_s: float,
) -> None:
    """Wait until a node's own topics are matched.

    Raises:
        PeerError: They are not within the time.
    """

    def reason() -> str:
        return unmatched(publishers, listeners())

    if not await until_true(node, lambda: not reason(), timeout_s):
        raise PeerError(f'{reason()} after {timeout_s:g} s, expected a running node')


def with_others(node: Node, listeners: Mapping[str, int]) -> dict[str, int]:
    """Return the least numbers of listeners where whoever else listens is not one of them."""
    return {
        topic: max(least, count_subscriber_nodes(node, topic))
        for topic, least in listeners.items()
    }


def _succeeded(client: Any, response: Any) -> Any:
    if not response.success:
        raise PeerError(f'{client.service_name}: {response.message}')
    return response


def key_values(mapping: Mapping[str, str]) -> list[KeyValue]:
    """Return a mapping as messages."""
    return [KeyValue(key=key, value=value) for key, value in mapping.items()]
