# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `recorder`: writes a run's bag from what is on the topics, byte for byte."""

from collections.abc import Callable
from functools import partial

from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_interfaces.msg import EpisodeResult
from hexapod_interfaces.srv import FinishRecording, RecordEpisode, SecureRecording, StartRecording
from hexapod_node.coroutines import create_coroutine_service, in_thread, until_true
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.node import Node
from hexapod_node.parameters import Parameter, declare
from hexapod_node.qos import LOCK_STEP
from hexapod_node.raw_topics import subscribe_raw
from hexapod_node.root import ROOT, OutsideRootError, Root
from hexapod_node.spin import run
from hexapod_node.stamps import time_message, to_nanoseconds
from hexapod_sim.robot import CONTROL_PERIOD_NS
from rclpy.serialization import deserialize_message

from hexapod_doe.bags.carry_over import open_recording
from hexapod_doe.bags.recording import Recording
from hexapod_doe.bags.run_bag import EPISODE_RESULT, EVALUATION_TOPIC, RESULT_TOPIC
from hexapod_doe.bags.salvage import set_aside
from hexapod_doe.errors import BagError
from hexapod_doe.nodes.sampled_topics import SampledTopics, recorded_topic


def _seconds(name: str, default: float, description: str) -> Parameter:
    return Parameter(name, default, description, unit='s', range=(0.0, 600.0), read_only=False)


PARAMETERS = (
    ROOT,
    _seconds(
        'control_period',
        CONTROL_PERIOD_NS * 1e-9,
        'Grid of the stamps, on which missing samples are found; 0 where there is none.',
    ),
    _seconds('match_timeout', 5.0, 'How long to wait for the publishers of a sampled episode.'),
    _seconds(
        'drain_timeout',
        6.0,  # two heartbeats of DDS, at which it sends again what was lost
        'How long to wait at the end of a sampled episode for its last samples.',
    ),
    _seconds(
        'result_timeout',
        6.0,
        'How long to wait for the last episode results, at a checkpoint and at the end of a run.',
    ),
)


class RecorderNode(Node):
    """Holds the bag of at most one run.

    The results of its episodes are recorded throughout, its other topics in sampled episodes.
    """

    def __init__(self) -> None:
        super().__init__('recorder')
        declare(self, PARAMETERS)
        self._recording: Recording | None = None
        self._samples = SampledTopics(self, self._on_sample)
        self._root = Root(self.get_parameter('root').value)
        self._failure = ''
        """Why nothing more can be recorded of the run."""
        self._dropped = 0
        create_coroutine_service(self, StartRecording, '~/start', self._on_start)
        create_coroutine_service(self, RecordEpisode, '~/episode', self._on_episode)
        create_coroutine_service(self, SecureRecording, '~/secure', self._on_secure)
        create_coroutine_service(self, FinishRecording, '~/finish', self._on_finish)
        # Always there, so that it is matched when a run begins.
        for topic in (RESULT_TOPIC, EVALUATION_TOPIC):
            on_result = partial(self._on_result, topic)
            subscribe_raw(self, topic, EPISODE_RESULT, on_result, LOCK_STEP)
        Diagnostics(self, self._health)

    def destroy_node(self) -> None:
        """Leave the bag of an open run readable, under its unfinished name."""
        self._abandon('the recorder stops')
        super().destroy_node()

    # Services

    async def _on_start(
        self, request: StartRecording.Request, response: StartRecording.Response
    ) -> StartRecording.Response:
        """Open the bag of a run."""
        try:
            if not request.run_id or not request.bag:
                raise BagError(
                    f"run '{request.run_id}', bag '{request.bag}': expected both to be named"
                )
            bag = self._root.inside('bag', request.bag)
            topics = [self.resolve_topic_name(topic) for topic in request.topics]
            self._abandon(f'run {request.run_id} begins')
            cut = set_aside(bag, request.takeover)
            if cut is not None:
                self.get_logger().warning(f'an earlier recording was cut; it is now {cut}')
            begin = partial(
                open_recording,
                request.run_id,
                bag,
                {entry.key: entry.value for entry in request.metadata},
                round(self._seconds('control_period') * 1e9),
                request.keep,
                self.resolve_topic_name(RESULT_TOPIC),
            )
            self._recording, response.kept, last_ns = await in_thread(self, begin)
        except (BagError, OutsideRootError) as error:
            response.message = str(error)
            return response
        self._samples.names = topics
        self._failure = ''
        response.last = time_message(last_ns)
        response.success = True
        return response

    async def _on_episode(
        self, request: RecordEpisode.Request, response: RecordEpisode.Response
    ) -> RecordEpisode.Response:
        """Begin or end to record every topic."""
        try:
            recording = self._usable_recording()
            if request.enable:
                await self._samples.begin(recording, request.episode)
            else:
                faults = await self._samples.end(recording, to_nanoseconds(request.last))
                for fault in faults:
                    self.get_logger().warning(f'run {recording.run_id}, {fault}')
                response.message = '; '.join(faults)
            response.success = True
        except BagError as error:
            self._samples.close()
            response.message = str(error)
        response.topics = self._samples.subscribed
        return response

    async def _on_secure(
        self, request: SecureRecording.Request, response: SecureRecording.Response
    ) -> SecureRecording.Response:
        """Answer once the disk has the first results."""
        try:
            recording = await self._once(lambda r: r.first_lacking(request.episodes) is None)
            lacking = recording.first_lacking(request.episodes)
            if lacking is not None:
                raise BagError(f'run {recording.run_id}: no result of episode {lacking} came')
            recording.secure()
            response.success = True
        except BagError as error:
            response.message = str(error)
        return response

    async def _on_finish(
        self, request: FinishRecording.Request, response: FinishRecording.Response
    ) -> FinishRecording.Response:
        """Close the bag, or say why it cannot be closed."""
        try:
            recording = await self._once(lambda r: not r.lacking(request.episodes))
            self._samples.close()
            self._recording = None
            metadata = {entry.key: entry.value for entry in request.metadata}
            response.messages = recording.messages
            finish = partial(recording.finish, request.episodes, metadata)
            response.bag = str(await in_thread(self, finish))
            response.success = True
        except BagError as error:
            response.message = str(error)
        return response

    async def _once(self, has_results: Callable[[Recording], bool]) -> Recording:
        """Return the recording once it has the results, or when none came for too long."""
        recording = self._usable_recording()
        await until_true(self, lambda: has_results(recording), self._seconds('result_timeout'))
        return self._usable_recording()

    # Messages

    def _on_result(self, name: str, data: bytes) -> None:
        recording = self._recording
        if recording is None or self._failure:
            return
        result = deserialize_message(data, EpisodeResult)
        if result.run_id != recording.run_id:
            self.get_logger().warning(
                f"{name}: result of run '{result.run_id}' ignored, "
                f"expected run '{recording.run_id}'",
                throttle_duration_sec=10.0,
            )
            return
        full = self.resolve_topic_name(name)
        topic = recorded_topic(full, self.get_publishers_info_by_topic(full))
        try:
            recording.add_result(topic, data, result.episode, result.steps)
        except BagError as error:
            self._fail(error)
        except ValueError as error:
            self._drop(name, error)

    def _on_sample(self, topic: str, data: bytes) -> None:
        if self._recording is None or self._failure:
            return
        try:
            self._recording.add_sample(topic, data)
        except BagError as error:
            self._fail(error)
        except ValueError as error:
            self._drop(topic, error)

    def _drop(self, topic: str, error: ValueError) -> None:
        """Leave out a message that no bag can hold; what a run lacks is found at its end."""
        self._dropped += 1
        self.get_logger().warning(f'{topic}: dropped: {error}', throttle_duration_sec=2.0)

    # State

    def _usable_recording(self) -> Recording:
        if self._failure:
            raise BagError(self._failure)
        if self._recording is None:
            raise BagError(f'no run is being recorded, expected a call of {self.get_name()}/start')
        return self._recording

    def _fail(self, error: Exception) -> None:
        self._failure = str(error)
        self.get_logger().error(self._failure)

    def _abandon(self, reason: str) -> None:
        recording, self._recording = self._recording, None
        self._samples.close()
        if recording is None:
            return
        try:
            left = recording.abandon()
        except BagError as error:
            self._fail(error)
            return
        self.get_logger().warning(
            f'run {recording.run_id} ends unfinished, {reason}; its bag stays {left}'
        )

    def _seconds(self, parameter: str) -> float:
        return float(self.get_parameter(parameter).value)

    def _health(self) -> Health:
        if self._failure:
            return DiagnosticStatus.ERROR, self._failure, {}
        if self._recording is None:
            return DiagnosticStatus.OK, 'idle', {}
        recording = self._recording
        amiss = recording.incomplete or self._dropped
        level = DiagnosticStatus.WARN if amiss else DiagnosticStatus.OK
        return (
            level,
            f'recording run {recording.run_id}',
            {
                'bag': recording.bag,
                'messages': recording.messages,
                'episodes': len(recording.results),
                'sampling': recording.sampling,
                'dropped': self._dropped,
                'incomplete': len(recording.incomplete),
            },
        )


def main() -> None:
    """Run the node until a signal comes."""
    run(RecorderNode)


if __name__ == '__main__':
    main()
