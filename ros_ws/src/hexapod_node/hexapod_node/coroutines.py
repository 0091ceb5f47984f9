# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Coroutines that are resumed by the event that they wait for, and what they wait for.

rclpy's own tasks poll: a coroutine that awaits a future is called again and again until it is
done, which keeps a core busy. Here the future's done-callback resumes it, so waiting costs nothing
and the coroutine goes on inside the very callback that brought the message.
"""

import threading
import time
import types
from collections.abc import Callable, Coroutine, Generator
from concurrent import futures
from typing import Any, TypeVar

from rclpy.client import Client
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.service import Service
from rclpy.task import Future

from hexapod_node.handlers import failed
from hexapod_node.timers import call_every, call_later, call_soon
from hexapod_node.upstream import answer_later

STEADY = Clock(clock_type=ClockType.STEADY_TIME)
"""A clock for timers of rclpy that goes on when simulated time stands."""
_POLL_S = 0.005
_LOOK_S = 0.5
Result = TypeVar('Result')
Handler = Callable[[Any, Any], Coroutine[Future, None, Any]]


class ServiceUnavailableError(TimeoutError):
    """A service has no server, or its server did not answer in time."""


@types.coroutine
def until(future: Future) -> Generator[Future, None, Any]:
    """Wait for a future and return its result, or raise its exception."""
    if not future.done():
        yield future
    return future.result()


def start(coroutine: Coroutine[Future, None, Any]) -> Future:
    """Run a coroutine that waits with `until`; return the future of what it returns or raises."""
    done = Future()

    def resume(_: Future | None = None) -> None:
        try:
            awaited = coroutine.send(None)
        except StopIteration as stop:
            done.set_result(stop.value)
        except Exception as error:
            done.set_exception(error)
        else:
            awaited.add_done_callback(resume)

    resume()
    return done


async def pause(node: Node) -> None:
    """Let the executor serve what else is due."""
    turn = Future()
    call_soon(node, lambda: turn.set_result(None))
    await until(turn)


async def sleep(node: Node, seconds: float) -> None:
    """Wait without blocking the executor, on a clock that goes on when simulated time stands."""
    done = Future()
    timer = call_later(node, seconds, lambda: done.set_result(None))
    try:
        await until(done)
    finally:
        timer.cancel()


async def until_true(node: Node, condition: Callable[[], bool], timeout_s: float) -> bool:
    """Wait on the steady clock, also while simulated time stands still.

    Returns:
        Whether the condition came true within the time.
    """
    deadline = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline:
            return False
        await sleep(node, _POLL_S)
    return True


async def until_lost(
    node: Node, answer: Future, present: Callable[[], bool], timeout_s: float
) -> bool:
    """Wait for an answer for as long as whoever owes it is there.

    Returns:
        Whether there is one; False once nobody has been present for so long.
    """
    over = Future()
    seen = time.monotonic()

    def settle(_: Future | None = None) -> None:
        if not over.done():
            over.set_result(None)

    def look() -> None:
        nonlocal seen
        now = time.monotonic()
        if present():
            seen = now
        elif now - seen > timeout_s:
            settle()

    answer.add_done_callback(settle)
    timer = call_every(node, _LOOK_S, look)
    try:
        await until(over)
    finally:
        timer.cancel()
    return answer.done()


async def in_thread(node: Node, work: Callable[[], Result]) -> Result:
    """Return what some work returns, or raise what it raises; the node serves others meanwhile.

    The thread does not keep the process alive: work is cut when the process ends.
    """
    done: futures.Future[Result] = futures.Future()
    turn = Future()
    done.add_done_callback(lambda _: call_soon(node, lambda: turn.set_result(None)))
    threading.Thread(target=_run, args=(work, done), daemon=True).start()
    await until(turn)
    return done.result()


def _run(work: Callable[[], Result], done: futures.Future[Result]) -> None:
    try:
        done.set_result(work())
    except BaseException as error:
        done.set_exception(error)


async def call(node: Node, client: Client, request: Any, timeout_s: float) -> Any:
    """Wait for the server, call it and return its response.

    Raises:
        ServiceUnavailableError: no server appeared, or none answered, within the time.
    """
    if not await until_true(node, client.service_is_ready, timeout_s):
        raise ServiceUnavailableError(
            f'service {client.service_name}: no server within {timeout_s:g} s, expected a '
            f'running node that offers it'
        )
    answer = client.call_async(request)
    timer = call_later(node, timeout_s, lambda: _give_up(client, answer, timeout_s))
    try:
        return await until(answer)
    finally:
        timer.cancel()


def _give_up(client: Client, answer: Future, timeout_s: float) -> None:
    if not answer.done():
        answer.set_exception(
            ServiceUnavailableError(
                f'service {client.service_name}: no answer within {timeout_s:g} s'
            )
        )


def create_coroutine_service(node: Node, kind: type, name: str, handler: Handler) -> Service:
    """Offer a service whose handler is a coroutine that waits with `until`.

    EventsExecutor hands what a callback returns straight to `send_response`, so a coroutine
    function cannot be one. Here it returns a future, and sending waits for it; any executor
    serves it.

    Args:
        node: that offers it.
        kind: service type.
        name: of the service.
        handler: takes request and response, returns the response to send.
    """
    service = node.create_service(
        kind, name, lambda request, response: start(handler(request, response))
    )
    send = service.send_response

    def answer(future: Future, header: Any) -> None:
        error = future.exception()
        send(failed(node, kind, name, error) if error else future.result(), header)

    answer_later(service, answer)
    return service
