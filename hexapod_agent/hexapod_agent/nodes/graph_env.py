# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The Gymnasium environment HexapodGraph-v0: a step is a control period of live nodes."""

import itertools
import os
import signal
import subprocess
import sys
from collections.abc import Coroutine
from pathlib import Path
from typing import Any

import numpy as np
from hexapod_interfaces.msg import CpgCommand
from hexapod_node.coroutines import start
from hexapod_node.intra_process import LockStepPublisher
from hexapod_node.lifeline import LAUNCHED
from hexapod_node.node import Node
from hexapod_node.session import begin
from hexapod_node.spin import spin_once
from hexapod_sim.task import Outcome
from numpy.typing import NDArray
from rclpy.context import Context
from rclpy.experimental.events_executor import EventsExecutor

from hexapod_agent.environment.env import LineEnv, Observation
from hexapod_agent.environment.evaluation import GraphError
from hexapod_agent.nodes.control_loop import ControlLoop
from hexapod_agent.nodes.peers import Peers, until_heard, with_others
from hexapod_agent.specification.run_spec import RunSpec

_POLL_S = 0.1
_END_S = 10.0
_EXECUTABLES = {
    'sim': 'hexapod_sim.nodes.executables:sim_node',
    'cpg': 'hexapod_cpg.nodes.executables:cpg_node',
}
_numbers = itertools.count()


class RobotProcesses:
    """A sim and a pattern generator as processes, which end with this one.

    Attributes:
        namespace: Theirs.
        processes: By their nodes.
    """

    def __init__(self) -> None:
        """Start them."""
        self.namespace = f'/gym_{os.getpid()}_{next(_numbers)}'
        self.processes = {
            name: self._started(*path.split(':')) for name, path in _EXECUTABLES.items()
        }

    def _started(self, module: str, function: str) -> subprocess.Popen[bytes]:
        code = f'from {module} import {function}; {function}()'
        arguments = ['--ros-args', '-r', f'__ns:={self.namespace}', '--log-level', 'warn']
        return subprocess.Popen(
            [sys.executable, '-c', code, *arguments], env=os.environ | {LAUNCHED: '1'}
        )

    def check(self) -> None:
        """Refuse to go on without one of them.

        Raises:
            GraphError: One has ended.
        """
        for name, process in self.processes.items():
            if (status := process.poll()) is not None:
                raise GraphError(
                    f'{self.namespace}/{name} ended with status {status}, expected it to run; '
                    'close this environment and make another one'
                )

    def end(self) -> None:
        """Ask them to end, and end those that have not after a while."""
        for process in self.processes.values():
            process.send_signal(signal.SIGINT)
        for process in self.processes.values():
            try:
                process.wait(_END_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


class RobotClient:
    """What drives the robot of a namespace from a program that is no node: it waits for answers.

    It has a context of rclpy of its own, so that a program may have several, and nodes beside.
    """

    def __init__(
        self, config: RunSpec, namespace: str, timeout_s: float, robot: RobotProcesses | None
    ) -> None:
        self._robot, self._timeout_s = robot, timeout_s
        self._context = Context()
        begin([], self._context)
        name = f'gym_{os.getpid()}_{next(_numbers)}'
        self._node = Node(name, namespace=namespace, context=self._context)
        self._executor = EventsExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._commands = LockStepPublisher(self._node, CpgCommand, 'cpg/command')
        self._loop = ControlLoop(self._node, self._commands, config, timeout_s)
        self._peers = Peers(self._node, timeout_s)
        self._wait(self._peers.configure_run(config))

    def begin_episode(self, seed: int) -> tuple[Observation, Outcome]:
        """Let an episode begin, and observe its start."""
        self._wait(self._begin(seed))
        return self.observe()

    async def _begin(self, seed: int) -> None:
        def listeners() -> dict[str, int]:
            return with_others(self._node, self._loop.listeners())

        self._loop.make_ready()
        await until_heard(self._node, [self._commands], listeners, self._timeout_s)
        self._loop.begin_episode(await self._peers.begin_episode(seed, listeners))

    def act(self, action: NDArray[np.float32]) -> None:
        """Have the robot do what an action says."""
        self._loop.act(action)

    def observe(self) -> tuple[Observation, Outcome]:
        """Wait for the end of the period, and observe it."""
        found: tuple[Observation, Outcome] = self._wait(self._loop.observe())
        return found

    def _wait(self, coroutine: Coroutine[Any, None, Any]) -> Any:
        """Serve the node until a coroutine is done.

        Raises:
            GraphError: A node is not there any more, or refused.
        """
        done = start(coroutine)
        try:
            while not done.done():
                spin_once(self._executor, _POLL_S)
                if self._robot is not None:
                    self._robot.check()
            return done.result()
        except (TimeoutError, RuntimeError) as error:
            raise error if isinstance(error, GraphError) else GraphError(str(error)) from error

    def close(self) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        self._loop.destroy()
        self._node.destroy_node()
        self._context.try_shutdown()


class HexapodGraph(LineEnv):
    """HexapodLine-v0 on the node graph, for learners that know nothing of it.

    A step sends `cpg/command`, and waits until each topic that is observed has delivered the
    period after it. Spaces, rewards, starts and ends are those of HexapodLine-v0, whose numbers it
    gives to the last bit; so are the arguments of `reset`.

    ## Information
    `terms` (each reward term) and `cause`, as HexapodLine-v0 has them.

    ## Arguments
    `observations` and `config` as for HexapodLine-v0. `namespace`: of a running worker, which must
    have no run meanwhile; without one, a sim and a pattern generator are started as processes in
    a namespace of their own, and `close` ends them. `timeout`: longest wait for a node, s.

    ## Errors
    `reset` and `step` raise `GraphError` where a node is not there, or not any more.

    ## Version history
    * v0: first version.
    """

    metadata: dict[str, Any] = {'render_modes': []}  # noqa: RUF012 (gymnasium's type)

    def __init__(
        self,
        observations: str | None = None,
        config: RunSpec | str | Path | None = None,
        namespace: str = '',
        timeout: float = 10.0,
    ) -> None:
        super().__init__(observations, config)
        self.robot = None if namespace else RobotProcesses()
        """The processes that are this environment's own."""
        self._client: RobotClient | None = None
        self._over = True
        place = self.robot.namespace if self.robot else namespace
        try:
            self._client = RobotClient(self.config, place, timeout, self.robot)
        except BaseException:
            self.close()
            raise

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode, as HexapodLine-v0 does."""
        chosen = self._begin(seed, options)
        observation, outcome = self._connected().begin_episode(chosen)
        self._over = False
        return observation, _info(outcome)

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Advance one control period of 25 ms."""
        if self._over:
            raise GraphError('step: no episode is under way, expected reset() before it')
        client = self._connected()
        client.act(action)
        observation, outcome = client.observe()
        self._over = outcome.terminated or outcome.truncated
        return observation, outcome.reward, outcome.terminated, outcome.truncated, _info(outcome)

    def close(self) -> None:
        """Leave the graph, and end what was started for it."""
        if self._client is not None:
            self._client.close()
        if self.robot is not None:
            self.robot.end()
        self._client = self.robot = None

    def _connected(self) -> RobotClient:
        if self._client is None:
            raise GraphError('this environment is closed, expected another one')
        return self._client


def _info(outcome: Outcome) -> dict[str, Any]:
    return {'terms': outcome.terms, 'cause': outcome.cause}
