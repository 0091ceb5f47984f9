# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `agent`: offers the action `train_run` and accepts one run at a time."""

import sys
from collections.abc import Sequence

from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_interfaces.action import TrainRun
from hexapod_interfaces.msg import CpgCommand, EpisodeResult
from hexapod_node.actions import CoroutineActionServer
from hexapod_node.coroutines import sleep
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.intra_process import LockStepPublisher
from hexapod_node.node import Node
from hexapod_node.parameters import Parameter, declare
from hexapod_node.qos import LOCK_STEP
from hexapod_node.root import READABLE, ROOT, Root
from hexapod_node.shared_memory import free_abandoned
from hexapod_node.spin import run
from rclpy.action import CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle

from hexapod_agent.deployment import agent_file
from hexapod_agent.deployment.agent_file import CheckpointError
from hexapod_agent.learning import run_checkpoint
from hexapod_agent.learning.numerics import check_precision, resolved
from hexapod_agent.learning.player import Agent, Player
from hexapod_agent.learning.training import Trainer
from hexapod_agent.nodes.action_names import PLAY_RUN, TRAIN_RUN
from hexapod_agent.nodes.graph_run import CanceledError, GraphRun, MakeTrainer, RunContext
from hexapod_agent.nodes.peers import Peers
from hexapod_agent.specification.run_spec import RunSpec

PARAMETERS = (
    Parameter(
        'timeout',
        10.0,
        'longest wait for a service, or for a topic to deliver its sample',
        unit='s',
        range=(0.1, 3600.0),
    ),
    Parameter(
        'for_hire', True, f'whether campaigns may give it runs; if not, its action is {PLAY_RUN}'
    ),
    ROOT,
    READABLE,
)


class AgentNode(Node):
    """Observes the topics of a run's set, acts through `cpg/command` and learns meanwhile."""

    def __init__(self, make_trainer: MakeTrainer = Trainer, action: str = '') -> None:
        """Offer the action.

        Args:
            make_trainer: what learns.
            action: name of the action; empty for what the parameter `for_hire` says.
        """
        super().__init__('agent')
        declare(self, PARAMETERS)
        timeout_s = float(self.get_parameter('timeout').value)
        self._run_context = RunContext(
            self,
            LockStepPublisher(self, CpgCommand, 'cpg/command'),
            self.create_publisher(EpisodeResult, 'episode_result', LOCK_STEP),
            self.create_publisher(EpisodeResult, 'evaluation_result', LOCK_STEP),
            Peers(self, timeout_s),
            timeout_s,
            make_trainer,
        )
        self._root = Root(self.get_parameter('root').value, self.get_parameter('readable').value)
        self._run: GraphRun | None = None
        self._reserved = False
        self._last_error = ''
        self._server = CoroutineActionServer(
            self,
            TrainRun,
            action or (TRAIN_RUN if self.get_parameter('for_hire').value else PLAY_RUN),
            self._train,
            goal_callback=self._on_goal,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )
        Diagnostics(self, self._health)

    def _on_goal(self, goal: TrainRun.Goal) -> GoalResponse:
        """Accept a run unless one is under way."""
        if self._reserved:
            self.get_logger().warning(f'run {goal.run_id} refused: another run is under way')
            return GoalResponse.REJECT
        self._reserved = True
        return GoalResponse.ACCEPT

    async def _train(self, goal_handle: ServerGoalHandle) -> TrainRun.Result:
        """Run one goal to its end, then make ready for the next."""
        result = await self._execute(goal_handle)
        # Leave the callback that brought the last sample before its subscription goes.
        await sleep(self, 0.0)
        ended, self._run = self._run, None
        self._reserved = False
        if ended is not None:
            ended.destroy()
        return result

    async def _execute(self, goal_handle: ServerGoalHandle) -> TrainRun.Result:
        """Run one goal; an error ends the run, not the node."""
        goal = goal_handle.request
        self._last_error = ''
        try:
            self._check(goal)
            config, agent = self._loaded(goal)
            self._run = GraphRun(self._run_context, goal_handle, config, agent)
            return await self._run.execute()
        except CanceledError as canceled:
            goal_handle.canceled()
            return TrainRun.Result(message=str(canceled), episodes=canceled.episodes)
        except Exception as error:
            self._last_error = f'run {goal.run_id}: {error}'
            self.get_logger().error(self._last_error)
            if goal_handle.is_active:
                goal_handle.abort()
            return TrainRun.Result(message=str(error))

    def _check(self, goal: TrainRun.Goal) -> None:
        """Make the goal's paths absolute.

        Raises:
            ValueError: one is not there, or not for a request to name.
        """
        if goal.checkpoint:
            path = self._root.readable('checkpoint', goal.checkpoint)
            if not path.is_file():
                raise ValueError(f"checkpoint '{path}' not found, expected a file")
            goal.checkpoint = str(path)
        if goal.bag:
            goal.bag = str(self._root.inside('bag', goal.bag))

    def _loaded(self, goal: TrainRun.Goal) -> tuple[RunSpec, Agent]:
        """Return what the goal asks for.

        Raises:
            ValueError: its specification is not one, or its checkpoint cannot be used. Why may
                quote that file, so only this machine is told.
        """
        if not goal.checkpoint:
            config = resolved(RunSpec.from_text(goal.spec, 'spec'))
            check_precision(config)
            return config, self._resumed(goal, config)
        try:
            return trained(goal)
        except CheckpointError as error:
            _tell_this_machine(f'run {goal.run_id}: {error}')
            raise ValueError(
                f"'{goal.checkpoint}': cannot be used, this worker prints why"
            ) from None

    def _resumed(self, goal: TrainRun.Goal, config: RunSpec) -> Trainer:
        """Return the trainer of the run's checkpoint, or one that begins."""
        trainer = None
        if goal.resume and goal.bag:
            try:
                trainer = run_checkpoint.resumed(goal.bag, config, goal.seed)
            except CheckpointError as error:
                _tell_this_machine(f'run {goal.run_id}: {error}')
                self.get_logger().warning(
                    f'run {goal.run_id} begins anew: its checkpoint cannot be used'
                )
        return trainer or self._run_context.make_trainer(config, goal.seed)

    def _health(self) -> Health:
        if self._run is not None:
            return DiagnosticStatus.OK, self._run.phase, self._run.progress()
        if self._last_error:
            return DiagnosticStatus.ERROR, self._last_error, {}
        return DiagnosticStatus.OK, 'waiting for a run', {}


def _tell_this_machine(text: str) -> None:
    """Write to this process's own output: the node's log goes to every peer."""
    print(text, file=sys.stderr, flush=True)


def trained(goal: TrainRun.Goal) -> tuple[RunSpec, Agent]:
    """Return the agent of the goal's checkpoint, and the specification that it plays in.

    Raises:
        ValueError: the checkpoint cannot be read, the changes to its specification are none, or
            other channels than it observes are asked for.
    """
    agent = agent_file.load(goal.checkpoint)
    config = agent.config.changed_by_text(goal.spec, 'spec')
    if config.letters != agent.config.letters:
        raise ValueError(
            f"spec: observations '{config.letters}': checkpoint '{goal.checkpoint}' observes "
            f"'{agent.config.letters}', expected the same or none"
        )
    return config, Player(agent.policy, config.training.window)


def main(args: Sequence[str] | None = None) -> None:
    """Run the node until a signal comes."""
    free_abandoned()
    run(AgentNode, args)
