# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `shadow`: stands in for sim and pattern generator with what a bag holds of both.

The agent node does not notice: its resets are answered, its topics deliver period after period,
each when its command for the one before has come. The commands go nowhere but into a comparison.
"""

import os
from collections import defaultdict
from collections.abc import Collection, Sequence
from pathlib import Path

from hexapod_agent.deployment.agent_file import load
from hexapod_agent.nodes.action_names import PLAY_RUN
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_interfaces.action import TrainRun
from hexapod_interfaces.msg import CpgCommand
from hexapod_interfaces.srv import ResetEpisode
from hexapod_node.actions import ActionClient
from hexapod_node.coroutines import start, until, until_true
from hexapod_node.matching import listeners_of, unmatched
from hexapod_node.node import Node
from hexapod_node.qos import LOCK_STEP
from hexapod_node.raw_topics import message_class
from hexapod_node.root import root_arguments
from hexapod_node.spin import serving, spin_once
from hexapod_node.stamps import time_message, to_nanoseconds
from hexapod_sim.robot import CONTROL_PERIOD_NS
from rcl_interfaces.srv import SetParametersAtomically
from trajectory_msgs.msg import JointTrajectory

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.errors import BagError
from hexapod_doe.replays.episodes import Series, Span, episode_of, recorded_episodes
from hexapod_doe.replays.shadowing import (
    COMMAND,
    COMMAND_TYPE,
    Answer,
    Comparison,
    command_values,
    compare,
)

_OUTCOME = 'step_outcome'
_POLL_S = 0.02
_READY_S = 30.0


class ShadowNode(Node):
    """Delivers the recorded samples of an agent's topics in lock-step with its commands.

    Attributes:
        answers: the commands of each episode beside the recorded ones.
    """

    def __init__(self, bag: BagFile, spans: Sequence[Span], spec: ObservationSpec) -> None:
        """Read what the agent observes.

        Raises:
            BagError: a topic is missing, or it lacks a sample of a period.
        """
        super().__init__('shadow')
        self._commands = Series(bag, COMMAND, COMMAND_TYPE)
        self._spans = list(spans)
        topics = {name: bag.topic(name) for name in (*spec.topics, _OUTCOME)}
        self._samples = _samples(bag, (*topics.values(), self._commands.topic), self._spans)
        self._senders = {
            topics[name]: self.create_publisher(
                message_class(bag.types[topics[name]]), name, LOCK_STEP
            )
            for name in topics
        }
        self.answers: list[list[Answer]] = []
        self.create_subscription(CpgCommand, COMMAND, self._on_command, LOCK_STEP)
        for peer, on_reset in (('sim', self._on_reset), ('cpg', self._on_second_reset)):
            self.create_service(ResetEpisode, f'{peer}/reset', on_reset)
            name = f'{peer}/set_parameters_atomically'
            self.create_service(SetParametersAtomically, name, _on_configure)
        # What the agent waits for to be heard; nobody publishes it.
        self.create_subscription(JointTrajectory, 'joint_trajectory', _ignore, LOCK_STEP)
        self._client = ActionClient(self, TrainRun, PLAY_RUN)

    async def play(self, checkpoint: Path, timeout_s: float = _READY_S) -> None:
        """Have the agent of this namespace play every episode.

        Raises:
            BagError: no agent is there within the time, or it ended early; the text gives its
                reason.
        """
        if not await until_true(self, self._client.server_is_ready, timeout_s):
            action = self.resolve_topic_name(PLAY_RUN)
            raise BagError(f'action {action}: no server within {timeout_s:g} s, expected agent')
        goal = TrainRun.Goal(
            run_id='shadow',
            checkpoint=str(checkpoint.resolve()),
            spec=f'training: {{episodes: {len(self._spans)}}}',
        )
        handle = await until(self._client.send_goal_async(goal))
        response = await until(handle.get_result_async())
        if response.result.message:
            raise BagError(f'the agent on the recorded topics: {response.result.message}')

    def _on_reset(
        self, request: ResetEpisode.Request, response: ResetEpisode.Response
    ) -> ResetEpisode.Response:
        """Begin the next recorded episode, as the sim would; its start is the recorded one."""
        self._answer(request, response)
        if response.success:
            self.answers.append([])
            response.start = time_message(self._spans[len(self.answers) - 1].start_ns)
        return response

    def _on_second_reset(
        self, request: ResetEpisode.Request, response: ResetEpisode.Response
    ) -> ResetEpisode.Response:
        """Deliver the first period: the agent resets the pattern generator last."""
        self._answer(request, response)
        response.start = request.start
        if response.success:
            self._deliver(to_nanoseconds(request.start))
        return response

    def _answer(self, request: ResetEpisode.Request, response: ResetEpisode.Response) -> None:
        listeners = listeners_of(request.topics, request.subscriptions)
        response.message = unmatched(self._senders.values(), listeners)
        response.success = not response.message

    def _on_command(self, message: CpgCommand) -> None:
        """Keep the command and deliver what was recorded a period later, whatever it asks."""
        stamp = to_nanoseconds(message.header.stamp)
        told = command_values(self._commands.at(stamp))
        self.answers[-1].append((stamp, told, command_values(message)))
        self._deliver(stamp + CONTROL_PERIOD_NS)

    def _deliver(self, stamp_ns: int) -> None:
        for topic, sender in self._senders.items():
            sender.publish(self._samples[stamp_ns][topic])


def _samples(
    bag: BagFile, topics: Collection[str], spans: Sequence[Span]
) -> dict[int, dict[str, bytes]]:
    """Return the serialised samples by stamp and topic, commands among them.

    Raises:
        BagError: a topic lacks the sample of a period.
    """
    samples: defaultdict[int, dict[str, bytes]] = defaultdict(dict)
    for message in bag.messages(topics):
        samples[message.time_ns][message.topic] = message.data
    for span in spans:
        for stamp in range(span.start_ns, span.end_ns + 1, CONTROL_PERIOD_NS):
            absent = set(topics) - set(samples[stamp])
            if stamp == span.end_ns:
                absent -= {bag.topic(COMMAND)}  # nothing is asked any more
            if absent:
                raise BagError(
                    f'bag {bag.path}: no sample of {", ".join(sorted(absent))} at '
                    f'{stamp * 1e-9:.3f} s, expected one of each topic in every control period'
                )
    return samples


def _on_configure(
    _: SetParametersAtomically.Request, response: SetParametersAtomically.Response
) -> SetParametersAtomically.Response:
    """Agree: what is recorded was made with a configuration of its own."""
    response.result.successful = True
    return response


def _ignore(_: JointTrajectory) -> None:
    pass


def shadow_on_graph(path: Path, checkpoint: Path, episode: int | None) -> list[Comparison]:
    """Let an agent node act on the recorded topics, and compare.

    Args:
        path: of the bag.
        checkpoint: the agent.
        episode: number of one episode; None for all that are recorded.

    Raises:
        BagError: the bag cannot be shadowed, or the agent ended early.
    """
    bag, spec = BagFile(path), load(checkpoint).spec
    spans = recorded_episodes(bag, Series(bag, COMMAND, COMMAND_TYPE))
    if episode is not None:
        spans = [episode_of(episode, spans, bag)]
    namespace, files = f'/shadow_{os.getpid()}', root_arguments('', checkpoint.resolve())
    with serving(
        lambda: (ShadowNode(bag, spans, spec), AgentNode(action=PLAY_RUN)), namespace, files
    ) as (
        executor,
        (node, _),
    ):
        played = start(node.play(checkpoint))
        while not played.done():
            spin_once(executor, _POLL_S)
        played.result()
        answers = zip(spans, node.answers, strict=True)
        return [compare(span.episode, found) for span, found in answers]
