# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""One run on the node graph, in training or play: its episodes, its bag and what it reports."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from hexapod_interfaces.action import TrainRun
from hexapod_interfaces.msg import EpisodeResult
from hexapod_node.matching import subscribed_topics
from hexapod_node.timers import call_every
from hexapod_sim.robot import CONTROL_PERIOD_NS
from hexapod_sim.sensor_table import CHANNELS
from hexapod_sim.task import EVALUATION_SEED, episode_seed

from hexapod_agent.learning import checkpoint, run_checkpoint
from hexapod_agent.learning.event_log import EventLog
from hexapod_agent.learning.numerics import set_numerics
from hexapod_agent.learning.player import Agent
from hexapod_agent.learning.provenance import provenance
from hexapod_agent.learning.summary import EpisodeSummary
from hexapod_agent.learning.training import Trainer
from hexapod_agent.nodes.control_loop import OUTCOME, ControlLoop
from hexapod_agent.nodes.messages import summary_to_message
from hexapod_agent.nodes.peers import Peers, until_heard, with_others
from hexapod_agent.specification.run_spec import RunSpec

if TYPE_CHECKING:
    from hexapod_node.intra_process import LockStepPublisher
    from rclpy.action.server import ServerGoalHandle
    from rclpy.node import Node
    from rclpy.publisher import Publisher

MakeTrainer = Callable[[RunSpec, int], Trainer]

_LIFE_S = 1.0
# What a sampled episode holds beside every sensor topic.
_PROTOCOL_TOPICS = (OUTCOME, 'odom', 'cpg/command', 'joint_trajectory', 'clock')
_SENSOR_TOPICS = tuple(topic for channel in CHANNELS for topic in channel.topics)


class CanceledError(RuntimeError):
    """Who gave the goal has taken it back.

    Attributes:
        episodes: That are complete.
    """

    def __init__(self, episodes: int) -> None:
        super().__init__('canceled')
        self.episodes = episodes


@dataclass(frozen=True)
class RunContext:
    """What a run uses of the node that was asked for it.

    Attributes:
        node: Subscribes, and names topics.
        commands: Publishes `cpg/command`.
        results: Publishes `episode_result`.
        evaluation: Publishes `evaluation_result`.
        peers: Services of the sim, the pattern generator and the recorder.
        timeout_s: Longest wait for a service or a sample.
        make_trainer: Makes what learns, of a specification and a seed.
    """

    node: Node
    commands: LockStepPublisher
    results: Publisher
    evaluation: Publisher
    peers: Peers
    timeout_s: float
    make_trainer: MakeTrainer


class GraphRun:
    """A run of the action `train_run`, from its first subscription to its closed bag.

    Attributes:
        phase: What is done at present: 'training', or 'evaluating' at the end.
    """

    def __init__(
        self,
        context: RunContext,
        goal_handle: ServerGoalHandle,
        config: RunSpec,
        agent: Agent,
    ) -> None:
        self._context, self._node = context, context.node
        self._goal_handle = goal_handle
        self._goal: TrainRun.Goal = goal_handle.request
        self._config, self._length = config, config.training.episodes
        self._agent = agent
        self._events: EventLog | None = None
        self._loop = ControlLoop(context.node, context.commands, config, context.timeout_s)
        self._episode = 0
        self._evaluation = 0 if self._goal.checkpoint else config.training.evaluation
        self.phase = 'training'
        self._last_ns = 0
        """End of the episodes that were carried over; simulated time goes on from there."""
        self._life = call_every(context.node, _LIFE_S, self._give_sign_of_life)

    def destroy(self) -> None:
        """Unsubscribe from every topic of the run, and close its curves."""
        self._life.cancel()
        self._loop.destroy()
        if self._events is not None:
            self._events.close()

    def progress(self) -> dict[str, object]:
        """Return what the diagnostics show."""
        counts = vars(self._loop.counts)
        return {'run_id': self._goal.run_id, 'episode': self._episode, **counts}

    async def execute(self) -> TrainRun.Result:
        """Run every episode, then close the bag and save an agent that has learned.

        Raises:
            CanceledError: The goal was taken back.
        """
        peers, goal, length = self._context.peers, self._goal, self._length
        await peers.configure_run(self._config)
        first = await self._open_bag() if goal.bag else 0
        if isinstance(self._agent, Trainer):
            set_numerics(self._config.training.precision)
        for self._episode in range(first, length):
            self._check_wanted(self._episode)
            await self._run_episode()
            await self._keep()
        found = await self._evaluate()
        agent, bag = goal.checkpoint, ''
        if goal.bag:
            if isinstance(self._agent, Trainer):
                agent = f'{goal.bag}.pt'
                checkpoint.save_agent(agent, self._agent)
            # A name, not a path: bags are moved, and their agents with them.
            found |= {'checkpoint': Path(agent).name}
            bag = await peers.finish_recording(length, found)
            run_checkpoint.forget(goal.bag)
        self._goal_handle.succeed()
        return TrainRun.Result(
            final_average_reward=self._agent.summary.average_return,
            evaluation_return=float(found.get('evaluation_return', math.nan)),
            episodes=self._episode + 1,
            checkpoint=agent,
            bag=bag,
        )

    async def _open_bag(self) -> int:
        """Have the bag opened, with the episodes before the checkpoint; return their number."""
        peers, goal = self._context.peers, self._goal
        await peers.greet_recorder()
        done = self._agent.episode if isinstance(self._agent, Trainer) else 0
        kept, self._last_ns = await peers.start_recording(
            goal.run_id, goal.bag, self._recorded_topics(), self._metadata(), goal.resume, done
        )
        if kept != done:
            self._node.get_logger().warning(
                f'run {goal.run_id} begins anew: no recording holds the {done} episodes before '
                'its checkpoint'
            )
            self._agent = self._context.make_trainer(self._config, goal.seed)
        self._events = EventLog(Path(f'{goal.bag}.tensorboard'), kept)
        return kept

    async def _keep(self) -> None:
        """Take a checkpoint if one is due, after its episodes' results are on the disk."""
        done, every = self._episode + 1, self._config.training.checkpoint_every
        if not self._goal.bag or done % every or done == self._length:
            return
        if isinstance(self._agent, Trainer):
            await self._context.peers.secure_recording(done)
            run_checkpoint.keep(self._goal.bag, self._agent)

    def _check_wanted(self, episodes: int) -> None:
        """Raise `CanceledError` if who gave the goal has taken it back."""
        if self._goal_handle.is_cancel_requested:
            raise CanceledError(episodes)

    async def _evaluate(self) -> dict[str, str]:
        """Have the run evaluated, if it is a training; return what its bag says of it."""
        if not self._evaluation or not isinstance(self._agent, Trainer):
            return {}
        player = self._agent.evaluator()
        self.phase = 'evaluating'
        while not player.is_done:
            self._check_wanted(self._episode + 1)
            if not player.start and self._config.robot.variations:
                await self._context.peers.configure_robot(player.config)
            is_reported = player.is_reported
            last_ns = await self._play(player, EVALUATION_SEED, player.start, sampled=False)
            if is_reported:
                self._context.evaluation.publish(self._result(player.summary, last_ns))
        return {'evaluation_return': repr(player.summary.average_return)}

    async def _run_episode(self) -> None:
        """Play one episode, and record all of it if it is a sampled one."""
        peers, episode = self._context.peers, self._episode
        every = self._goal.record_every
        sampled = bool(self._goal.bag) and every > 0 and (episode + 1) % every == 0
        if sampled:
            await peers.record_episode(episode, enable=True)
        last_ns = await self._play(self._agent, self._goal.seed, episode, sampled)
        if sampled:
            await peers.record_episode(episode, enable=False, last_ns=last_ns)
        self._report(last_ns)

    async def _play(self, agent: Agent, seed: int, episode: int, sampled: bool) -> int:
        """Let an agent drive one episode; return the stamp of its last sample, ns."""
        self._loop.make_ready()
        agent.begin_episode(episode)
        listeners = functools.partial(self._listeners, sampled)
        context = self._context
        publishers = context.commands, context.results, context.evaluation
        await until_heard(self._node, publishers, listeners, context.timeout_s)
        start_ns = await context.peers.begin_episode(
            episode_seed(seed, episode), listeners, self._last_ns + CONTROL_PERIOD_NS
        )
        return await self._loop.run_episode(agent, start_ns)

    def _listeners(self, sampled: bool) -> dict[str, int]:
        """Return how many subscriptions each topic must have before the episode begins."""
        resolve, listeners = self._node.resolve_topic_name, self._loop.listeners()
        if self._goal.bag:
            listeners |= {resolve('episode_result'): 1, resolve('evaluation_result'): 1}
        if sampled:
            for topic in self._recorded_topics():
                listeners[topic] = listeners.get(topic, 0) + 1
        return with_others(self._node, listeners)

    def _recorded_topics(self) -> list[str]:
        return [self._node.resolve_topic_name(t) for t in (*_SENSOR_TOPICS, *_PROTOCOL_TOPICS)]

    def _metadata(self) -> dict[str, str]:
        """Return what the bag says of the run; the plan's own entries come with the goal."""
        given = {entry.key: entry.value for entry in self._goal.metadata}
        node = self._node
        subscribed = subscribed_topics(node, node.get_name(), node.get_namespace())
        return given | {
            'observations': self._config.letters,
            'seed': str(self._goal.seed),
            'mode': 'play' if self._goal.checkpoint else 'train',
            'episodes': str(self._length),
            'window': str(self._config.training.window),
            'evaluation': str(self._evaluation),
            'spec': self._config.to_text(),
            'subscriptions': '\n'.join(subscribed),
            **provenance(),
        }

    def _report(self, last_ns: int) -> None:
        """Publish the episode's result and the action's feedback."""
        summary = self._agent.summary
        if self._events is not None:
            self._events.add(summary)
        self._context.results.publish(self._result(summary, last_ns))
        self._goal_handle.publish_feedback(
            TrainRun.Feedback(
                episode=self._episode,
                ended=True,
                episode_return=summary.episode_return,
                average_return=summary.average_return,
                periods=self._loop.periods,
            )
        )

    def _result(self, summary: EpisodeSummary, last_ns: int) -> EpisodeResult:
        return summary_to_message(self._goal.run_id, summary, self._loop.counts, last_ns)

    def _give_sign_of_life(self) -> None:
        """Tell whoever gave the goal that the run goes on."""
        if self._goal_handle.is_active:
            self._goal_handle.publish_feedback(
                TrainRun.Feedback(episode=self._episode, periods=self._loop.periods)
            )
