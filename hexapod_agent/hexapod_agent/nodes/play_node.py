# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `play`: plays a checkpoint, by the worker of its namespace or in real time by itself."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hexapod_interfaces.action import TrainRun
from hexapod_node.actions import ActionClient
from hexapod_node.coroutines import start, until, until_lost, until_true
from hexapod_node.diagnostics import Diagnostics
from hexapod_node.node import Node
from hexapod_node.parameters import Parameter, declare
from hexapod_node.spin import run
from hexapod_node.sync import REALTIME, SYNC
from rclpy.task import Future

from hexapod_agent.deployment.deployed_agent import DeployedAgent
from hexapod_agent.nodes import real_time
from hexapod_agent.nodes.action_names import PLAY_RUN, TRAIN_RUN
from hexapod_agent.specification.spec_text import changes_text

PARAMETERS = (
    SYNC,
    Parameter('checkpoint', '', 'agent to play: a file of train'),
    Parameter('config', '', "file of changes to the checkpoint's configuration; empty for none"),
    Parameter('episodes', 1, 'lockstep: how many episodes', range=(1, 1_000_000)),
    Parameter('seed', 1, 'lockstep: seed of the starts', range=(0, 2**63 - 1)),
    Parameter('bag', '', 'lockstep: directory of the bag to record; empty to record nothing'),
    Parameter(
        'worker_timeout',
        30.0,
        'lockstep: longest time without the worker, before the run and amid it',
        unit='s',
        range=(1.0, 86400.0),
    ),
)


class PlayNode(Node):
    """Has the worker play episodes in lock-step, or drives a robot in real time until a signal.

    Attributes:
        exit_status: of the process, once there is nothing more to do: 0 if all went well.
    """

    def __init__(self) -> None:
        super().__init__('play')
        declare(self, (*PARAMETERS, *real_time.PARAMETERS))
        self.exit_status: int | None = None
        if self._value('sync') == REALTIME:
            agent = DeployedAgent.load(self._checkpoint(), self._value('config'))
            self._play = real_time.RealTimePlay(self, agent)
            Diagnostics(self, self._play.health)
            start(self._play.begin()).add_done_callback(self._on_begun)
        else:
            goal = self._goal()
            # The launch file's own worker is not for hire; one that is will do.
            names = (PLAY_RUN, TRAIN_RUN)
            self._actions = {name: ActionClient(self, TrainRun, name) for name in names}
            start(self._have_played(goal)).add_done_callback(self._on_played)

    def _value(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _checkpoint(self) -> str:
        if not self._value('checkpoint'):
            raise ValueError("checkpoint '': expected a file of train")
        return str(self._value('checkpoint'))

    def _goal(self) -> TrainRun.Goal:
        value = {entry.name: self._value(entry.name) for entry in PARAMETERS}
        if value['bag'] and Path(_absolute(value['bag'])).exists():
            raise ValueError(
                f"bag '{value['bag']}' is there already, expected a new folder; give another one "
                'with bag:=FOLDER, or move it away'
            )
        return TrainRun.Goal(
            run_id=Path(value['bag']).name or 'play',
            checkpoint=_absolute(self._checkpoint()),
            spec=changes_text(value['config'], [f'training.episodes={value["episodes"]}']),
            seed=value['seed'],
            bag=_absolute(value['bag']),
            record_every=1,
        )

    async def _have_played(self, goal: TrainRun.Goal) -> TrainRun.Result:
        """Wait for the worker, send the goal and return its result.

        Raises:
            RuntimeError: there is no worker, it is busy, it ended the run early, or was lost.
        """
        timeout_s = self.get_parameter('worker_timeout').value
        if not await until_true(self, self._present, timeout_s):
            names = ' or '.join(self.resolve_topic_name(name) for name in self._actions)
            raise RuntimeError(f'no worker offers {names} after {timeout_s:g} s, expected one')
        client = next(c for c in self._actions.values() if c.server_is_ready())
        handle = await until(client.send_goal_async(goal))
        if not handle.accepted:
            raise RuntimeError('the worker is busy, expected it to be free')
        played = handle.get_result_async()
        if not await until_lost(self, played, client.server_is_ready, timeout_s):
            raise RuntimeError(
                f'the worker was lost amid the run, not seen for {timeout_s:g} s; its log says why'
            )
        result = played.result().result
        if result.message:
            raise RuntimeError(result.message)
        return result

    def _present(self) -> bool:
        return any(client.server_is_ready() for client in self._actions.values())

    def _on_begun(self, begun: Future) -> None:
        error = begun.exception()
        if error is not None:
            self.get_logger().error(str(error))
            self.exit_status = 1

    def _on_played(self, played: Future) -> None:
        error = played.exception()
        if error is not None:
            self.get_logger().error(str(error))
            self.exit_status = 1
            return
        result = played.result()
        bag = f', bag {result.bag}' if result.bag else ''
        self.get_logger().info(f'mean return {result.final_average_reward:.1f}{bag}')
        self.exit_status = 0


def _absolute(path: str) -> str:
    """Return the path as the worker understands it, wherever it runs; nothing stays nothing."""
    return str(Path(path).expanduser().resolve()) if path else ''


def main(args: Sequence[str] | None = None) -> None:
    """Run the node until its run is over or a signal comes."""
    run(PlayNode, args)
