# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A handler that fails answers so and is counted; its node goes on, whatever a peer sends."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from hexapod_interfaces.action import TrainRun
from hexapod_node.actions import ActionClient, CoroutineActionServer
from hexapod_node.coroutines import create_coroutine_service
from hexapod_node.diagnostics import Diagnostics
from hexapod_node.handlers import failures
from hexapod_node.newest import NumberedCallback
from hexapod_node.node import Node
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters, SetParametersAtomically
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

pytestmark = pytest.mark.graph


class Failing(Node):
    """Fails at the word `fail`, wherever it is asked."""

    def __init__(self) -> None:
        super().__init__('failing')
        self.heard: list[str] = []
        self.declare_parameter('known', 1)
        self.create_subscription(String, 'words', self._on_word, 10)
        self.create_subscription(String, 'words', NumberedCallback(self._on_numbered), 10)
        self.create_service(Trigger, '~/plain', self._fail)
        self.create_service(SetBool, '~/unsendable', self._unsendable)
        create_coroutine_service(self, Trigger, '~/later', self._fail_later)
        Diagnostics(self, lambda: (DiagnosticStatus.OK, 'fine', {}))

    def _on_word(self, message: String) -> None:
        if message.data == 'fail':
            raise KeyError('expected')
        self.heard.append(message.data)

    def _on_numbered(self, message: String, number: int | None) -> None:
        assert number is not None
        self._on_word(message)

    def _fail(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success = True
        raise OSError(28, 'No space left on device')

    def _unsendable(self, _: SetBool.Request, response: SetBool.Response) -> Any:
        return 'no response'

    async def _fail_later(self, _: Trigger.Request, response: Trigger.Response) -> Any:
        raise ValueError('the reason')


def test_messages_are_dropped_counted_and_named(graph) -> None:
    node = graph.add(Failing())
    words = graph.nodes[0].create_publisher(String, 'words', 10)
    reports: list[DiagnosticStatus] = []
    graph.nodes[0].create_subscription(
        DiagnosticArray, '/diagnostics', lambda m: reports.extend(m.status), 10
    )
    graph.until(lambda: words.get_subscription_count() == 2)
    for word in ('a', 'fail', 'b'):
        words.publish(String(data=word))
    graph.until(lambda: node.heard.count('b') == 2)
    assert node.heard.count('a') == 2
    assert failures(node) == {'words': 2}
    graph.until(lambda: any(r.level == DiagnosticStatus.WARN for r in reports))
    status = next(r for r in reports if r.level == DiagnosticStatus.WARN)
    assert status.message == 'fine; handlers failed: words'
    assert ('words.failed', '2') in [(entry.key, entry.value) for entry in status.values]


@pytest.mark.parametrize(
    ('name', 'reason'), [('plain', 'No space left on device'), ('later', 'the reason')]
)
def test_requests_are_answered_with_the_reason(graph, name: str, reason: str) -> None:
    graph.add(Failing())
    for _ in range(2):
        response = graph.call(Trigger, f'failing/{name}', Trigger.Request())
        assert not response.success
        assert reason in response.message


def test_a_response_that_cannot_be_sent_costs_its_client_alone(graph) -> None:
    node = graph.add(Failing())
    client = graph.nodes[0].create_client(SetBool, 'failing/unsendable')
    graph.until(client.service_is_ready)
    client.call_async(SetBool.Request())
    graph.until(lambda: failures(node)['~/unsendable'] == 1)
    assert not graph.call(Trigger, 'failing/plain', Trigger.Request()).success


def parameter(name: str, kind: int) -> Parameter:
    return Parameter(name=name, value=ParameterValue(type=kind, integer_value=5))


@pytest.mark.parametrize('kind', [10, 77, 255])
def test_parameters_of_unknown_types_are_refused_one_by_one(graph, kind: int) -> None:
    node = graph.add(Failing())
    known = parameter('known', ParameterType.PARAMETER_INTEGER)
    many = [parameter('known', kind), known, parameter('', kind), parameter('none', 2)]
    response = graph.call(
        SetParameters, 'failing/set_parameters', SetParameters.Request(parameters=many)
    )
    assert [result.successful for result in response.results] == [False, True, False, False]
    assert response.results[0].reason == f'known: type {kind}: unknown, expected 0 to 9'
    assert node.get_parameter('known').value == 5
    together = SetParametersAtomically.Request(parameters=many)
    answer = graph.call(SetParametersAtomically, 'failing/set_parameters_atomically', together)
    assert not answer.result.successful
    assert str(kind) in answer.result.reason
    got = graph.call(
        GetParameters, 'failing/get_parameters', GetParameters.Request(names=['known'])
    )
    assert got.values[0].integer_value == 5


class Erratic(CoroutineActionServer):
    """Fails at the first goal, outside of every callback."""

    fails = True

    async def _execute_goal_request(self, *taken: Any) -> None:
        if self.fails:
            self.fails = False
            raise RuntimeError('expected')
        await super()._execute_goal_request(*taken)


def test_an_action_goes_on_where_a_handler_of_server_or_client_failed(graph) -> None:
    async def execute(goal_handle: Any) -> TrainRun.Result:
        goal_handle.publish_feedback(TrainRun.Feedback(episode=7))
        goal_handle.succeed()
        return TrainRun.Result(message='done')

    node = graph.add(Failing())
    Erratic(node, TrainRun, 'erratic', execute)
    client = ActionClient(node, TrainRun, 'erratic')
    graph.until(client.server_is_ready)
    client.send_goal_async(TrainRun.Goal())
    graph.until(lambda: failures(node)['erratic'] == 1)

    def fail(_: Any) -> None:
        raise asyncio.InvalidStateError('expected')

    handle = graph.result(client.send_goal_async(TrainRun.Goal(), fail))
    assert graph.result(handle.get_result_async()).result.message == 'done'
    graph.until(lambda: failures(node)['erratic'] == 2)
