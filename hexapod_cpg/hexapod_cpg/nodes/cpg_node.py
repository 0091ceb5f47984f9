# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `cpg`: the pattern generator as a managed node, with the last word on every joint."""

from collections.abc import Callable, Sequence

from hexapod_node.diagnostics import Diagnostics, Health
from hexapod_node.node import Node
from hexapod_node.parameters import ConfigParameters, Parameter, declare
from hexapod_node.spin import run
from hexapod_node.sync import REALTIME, SYNC, max_age, phase
from hexapod_node.upstream import RCLError
from hexapod_sim.robot import NO_LOAD_SPEED
from lifecycle_msgs.srv import ChangeState
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.parameter import Parameter as RclpyParameter

from hexapod_cpg.joint_guard import JointGuard
from hexapod_cpg.locomotion import Locomotion
from hexapod_cpg.nodes.lock_step import LockStepCpg
from hexapod_cpg.nodes.measured_start import START_FROM
from hexapod_cpg.nodes.real_time import RealTimeCpg
from hexapod_cpg.oscillator import HopfConfig

PARAMETERS = (
    SYNC,
    Parameter('autostart', True, 'configure and activate the node when it starts'),
    max_age(
        'max_age',
        'a command, and of the joints that the robot starts from; it stops when the newest '
        'command is older',
    ),
    phase(0.010),
    Parameter(
        'max_joint_rate',
        NO_LOAD_SPEED,
        'greatest rate of a joint target; enforced in realtime, counted in lockstep',
        unit='rad/s',
        range=(0.1, 100.0),
    ),
    Parameter(
        'stop_rate',
        0.5,
        'rate of every joint on its way to the standing pose',
        unit='rad/s',
        range=(0.01, 10.0),
    ),
    START_FROM,
)


class CpgNode(Node, LifecycleNode):
    """The pattern generator and its mapping to joint angles.

    Active, it plays commands. Inactive, it brings the robot to its standing pose and holds it.
    Lock-step takes one control period per command; real time one per tick of the clock, from the
    measured joints on: it rises to the standing pose before it plays anything.
    """

    def __init__(self, parameter_overrides: Sequence[RclpyParameter] = ()) -> None:
        """Declare, connect, and start by itself unless told otherwise.

        Args:
            parameter_overrides: values that stand in for the command line's.
        """
        super().__init__('cpg', parameter_overrides=list(parameter_overrides))
        declare(self, PARAMETERS)
        config = ConfigParameters(self, HopfConfig.of_article(), 'cpg')
        value = {entry.name: self.get_parameter(entry.name).value for entry in PARAMETERS}
        self._locomotion = Locomotion(
            config.get(), JointGuard(value['max_joint_rate']), value['stop_rate']
        )
        mode = RealTimeCpg if value['sync'] == REALTIME else LockStepCpg
        self._mode: RealTimeCpg | LockStepCpg = mode(self, self._locomotion, config.get)
        Diagnostics(self, self._health)
        self._refuse_what_does_not_fit()
        if value['autostart']:
            self.trigger_configure()
            self.trigger_activate()

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Begin to hold the standing pose."""
        self._mode.configure()
        return super().on_configure(state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Play commands from now on."""
        self._mode.activate()
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Play no more commands: bring the robot to its standing pose."""
        self._mode.deactivate()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Leave the robot to itself, once it stands."""
        if fault := self._mode.cleanup_fault():
            self.get_logger().error(f'cleanup refused: {fault}')
            return TransitionCallbackReturn.FAILURE
        self._mode.release()
        return super().on_cleanup(state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Leave the robot to itself; in real time, once it stands."""
        self._mode.shutdown()
        return super().on_shutdown(state)

    def _refuse_what_does_not_fit(self) -> None:
        """Answer a transition that does not fit the state: rclpy raises, amid a stride."""
        (service,) = (s for s in self.services if s.srv_type is ChangeState)
        change: Callable[..., ChangeState.Response] = service.callback

        def answer(
            request: ChangeState.Request, response: ChangeState.Response
        ) -> ChangeState.Response:
            try:
                return change(request, response)
            except RCLError:
                wanted = request.transition.label or request.transition.id
                self.get_logger().error(
                    f'transition {wanted} refused: the state does not have it, expected one of '
                    f'`ros2 lifecycle list {self.get_name()}`'
                )
                response.success = False
                return response

        service.callback = answer

    def _health(self) -> Health:
        level, text, values = self._mode.health()
        guard = self._locomotion.guard
        common = {
            'motion': str(self._locomotion.motion),
            'beyond_limit': guard.beyond_limit,
            'beyond_rate': guard.beyond_rate,
        }
        return level, text, {**values, **common}


def main(args: Sequence[str] | None = None) -> None:
    """Run the node until a signal comes."""
    run(CpgNode, args)
