# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `sim`: the simulated robot, with the topics that a real robot's drivers would have."""

from collections import Counter
from collections.abc import Sequence

from diagnostic_msgs.msg import DiagnosticStatus
from hexapod_interfaces.srv import ResetEpisode
from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.intra_process import LockStepSubscription
from hexapod_node.invalid_message import fault_kind
from hexapod_node.matching import listeners_of, unmatched
from hexapod_node.node import Node
from hexapod_node.parameters import ConfigParameters, Parameter, declare
from hexapod_node.spin import run
from hexapod_node.stamp_gate import DuePeriod
from hexapod_node.stamps import requested_start_ns, time_message, to_nanoseconds
from hexapod_node.sync import REALTIME, SYNC, max_age, phase
from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter as RclpyParameter
from trajectory_msgs.msg import JointTrajectory

from hexapod_sim import quality
from hexapod_sim.nodes.messages import targets_from_message
from hexapod_sim.nodes.publishers import SimPublishers
from hexapod_sim.nodes.real_time import RealTime
from hexapod_sim.quality import Quality
from hexapod_sim.robot import CONTROL_PERIOD_NS
from hexapod_sim.scenes.table import SceneConfig
from hexapod_sim.task import LineTask, Outcome
from hexapod_sim.task_config import TaskConfig
from hexapod_sim.variations.table import RobotConfig
from hexapod_sim.viewer import Viewer
from hexapod_sim.world import World

_QUALITIES = 'sensors.qualities'

PARAMETERS = (
    SYNC,
    Parameter(
        'real_time_factor',
        1.0,
        'realtime: simulated seconds per second; with 1 stamps are of the system clock, else run '
        'the other nodes with use_sim_time',
        range=(0.01, 100.0),
    ),
    phase(0.0),
    max_age('max_age', 'a trajectory'),
    Parameter('seed', 1, 'realtime: seed of the start', range=(0, 2**63 - 1)),
    Parameter(
        _QUALITIES,
        '{}',
        "how good the devices are, as YAML of the specification's section sensors; a channel that "
        'is not named is perfect',
        read_only=False,
    ),
    Parameter('viewer', False, 'show the robot in a window, in real time; needs a display'),
)


class SimNode(Node):
    """Publishes what somebody listens to, and steps the physics.

    In lock-step once per joint trajectory, in real time once per tick of the clock.
    """

    def __init__(self) -> None:
        super().__init__('sim')
        declare(self, PARAMETERS)
        self._config = ConfigParameters(self, TaskConfig.of_article(), 'task')
        self._scene = ConfigParameters(self, SceneConfig.of_article(), 'scene')
        self._robot = ConfigParameters(self, RobotConfig.of_article(), 'robot')
        self._task = LineTask(self._config.get(), self._qualities(), self._world())
        self.add_on_set_parameters_callback(self._on_set)
        value = {entry.name: self.get_parameter(entry.name).value for entry in PARAMETERS}
        paced = value['sync'] != REALTIME
        self._viewer = Viewer(self._task.simulation, paced) if value['viewer'] else None
        self._now_ns = 0
        self._rejected: Counter[str] = Counter()
        self._due = DuePeriod(CONTROL_PERIOD_NS)
        self._topics = SimPublishers(self, self._task)
        self._real_time: RealTime | None = None
        if value['sync'] == REALTIME:
            self._real_time = RealTime(self, self._task, self._config.get(), self._publish)
        else:
            LockStepSubscription(
                self, JointTrajectory, 'joint_trajectory', self._on_joint_trajectory
            )
        self.create_service(ResetEpisode, '~/reset', self._on_reset)
        Diagnostics(self, self._health)

    def destroy_node(self) -> None:
        """Close the window, then the node."""
        if self._viewer is not None:
            self._viewer.close()
        super().destroy_node()

    def _on_reset(
        self, request: ResetEpisode.Request, response: ResetEpisode.Response
    ) -> ResetEpisode.Response:
        """Put the robot at the seeded start of an episode, a period after the last sample."""
        asked_ns = requested_start_ns(request.start)
        listeners = listeners_of(request.topics, request.subscriptions)
        response.message = unmatched(self._topics.all, listeners)
        response.success = not response.message
        if response.success:
            self._task.sensors.qualities = self._qualities()
            self._enter(self._world())
        if response.success and self._real_time is not None:
            response.start = time_message(self._real_time.reset(request.seed, self._config.get()))
            return response
        if response.success:
            self._task.config = self._config.get()
            outcome = self._task.reset(request.seed)
            self._now_ns = max(self._now_ns + CONTROL_PERIOD_NS, asked_ns)
            self._due.start(self._now_ns)
            self._publish(outcome, self._now_ns)
        response.start = time_message(self._now_ns)
        return response

    def _enter(self, world: World) -> None:
        """Go to the world of the next episodes, and let the window follow."""
        before = self._task.simulation
        self._task.enter(world)
        if self._viewer is not None and self._task.simulation is not before:
            self._viewer.close()
            self._viewer = Viewer(self._task.simulation, self._viewer.paced)

    def _world(self) -> World:
        return World(self._scene.get(), self._robot.get())

    def _qualities(self) -> dict[str, Quality]:
        return quality.from_text(self.get_parameter(_QUALITIES).value)

    def _on_set(self, parameters: list[RclpyParameter]) -> SetParametersResult:
        """Refuse what no device can be."""
        try:
            for parameter in parameters:
                if parameter.name == _QUALITIES:
                    quality.from_text(parameter.value)
        except ValueError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _on_joint_trajectory(self, message: JointTrajectory) -> None:
        """Advance one period, if the trajectory is the one of the period that is due."""
        if not self._due.admit(to_nanoseconds(message.header.stamp)):
            return
        try:
            outcome = self._task.advance(targets_from_message(message))
        except ValueError as error:
            self._rejected[fault_kind(error)] += 1
            self.get_logger().error(f'{error}; the period is not simulated')
            return
        self._now_ns += CONTROL_PERIOD_NS
        if outcome.terminated or outcome.truncated:
            self._due.stop()
        else:
            self._due.start(self._now_ns)
        self._publish(outcome, self._now_ns)

    def _publish(self, outcome: Outcome, now_ns: int) -> None:
        if self._viewer is not None:
            self._viewer.show()
        self._topics.publish(outcome, now_ns)

    def _health(self) -> Health:
        if self._real_time is not None:
            return self._real_time.health()
        faults = vars(self._due.counts) | {'rejected': self._rejected.total(), **self._rejected}
        if any(faults.values()):
            return DiagnosticStatus.WARN, 'trajectories came that were not due', faults
        return DiagnosticStatus.OK, 'in step', faults


def main(args: Sequence[str] | None = None) -> None:
    """Run the node until a signal comes."""
    run(SimNode, args)
