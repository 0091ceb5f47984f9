# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `realtime_report`: how well this machine keeps the robot's 40 Hz.

Runs sim, pattern generator and agent in real time, each in a process of its own, and prints what
their diagnostics say of the lateness of their ticks.
"""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from diagnostic_msgs.msg import DiagnosticArray
from hexapod_agent.deployment import agent_file
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_interfaces.srv import ResetEpisode
from hexapod_node.node import Node
from hexapod_node.session import begin
from hexapod_node.tick_meter import LATE_NS
from hexapod_sim.command_line import CommandLine, file, number
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.utilities import try_shutdown
from rich.console import Console
from rich.table import Table

NODES = ('sim', 'cpg', 'play')
TARGET_SHARE = 0.01
_START_S = 60.0
_WAIT_S = 0.1
_COLUMNS = {
    'ticks': 'ticks',
    'missed_ticks': 'missed',
    'lateness_median_ms': 'median ms',
    'lateness_p99_ms': '99 % ms',
    'lateness_max_ms': 'max ms',
    'late_share': f'more than {LATE_NS / 1e6:g} ms late',
}

Diagnosis = Mapping[str, str]


class ReportError(RuntimeError):
    """The nodes did not come to drive the robot; the text says what they printed."""


class Listener(Node):
    """Keeps the newest diagnostics of the nodes of a namespace.

    Attributes:
        heard: Values by name of the node.
    """

    def __init__(self, namespace: str) -> None:
        super().__init__('realtime_report', namespace=namespace)
        self.heard: dict[str, Diagnosis] = {}
        self._of = {f'{namespace}/{name}: state': name for name in NODES}
        self.reset = self.create_client(ResetEpisode, 'sim/reset')
        self.create_subscription(DiagnosticArray, '/diagnostics', self._on_diagnostics, 10)

    @property
    def driving(self) -> bool:
        """Whether every node is heard and the agent gives commands."""
        complete = len(self.heard) == len(NODES)
        return complete and self.heard['play']['state'] == 'driving'

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            if status.name in self._of:
                values = {entry.key: entry.value for entry in status.values}
                self.heard[self._of[status.name]] = values


def measure(seconds: float, agent: Path, directory: Path) -> dict[str, Diagnosis]:
    """Let the robot walk for a time and return the diagnostics of each node at its end.

    Args:
        seconds: How long to measure.
        agent: Checkpoint.
        directory: Where the nodes' output goes.

    Raises:
        ReportError: the agent does not come to drive.
    """
    namespace = f'/realtime_report_{os.getpid()}'
    begin([])
    listener = Listener(namespace)
    executor = EventsExecutor()
    executor.add_node(listener)

    def spin(done: Callable[[], bool], timeout_s: float) -> None:
        deadline = time.monotonic() + timeout_s
        while not done() and time.monotonic() < deadline:
            executor.spin_once(timeout_sec=_WAIT_S)

    try:
        with _nodes(namespace, agent, directory / 'output') as launch:
            spin(lambda: listener.driving or launch.poll() is not None, _START_S)
            if not listener.driving:
                output = (directory / 'output').read_text(encoding='utf-8')
                raise ReportError(f'the agent does not drive the robot:\n{output}')
            # Starting up is not what is asked for: the sim measures afresh from a reset on, the
            # others since the robot walks.
            done = listener.reset.call_async(ResetEpisode.Request(seed=1))
            spin(done.done, _START_S)
            spin(lambda: False, seconds)
            return dict(listener.heard)
    finally:
        executor.shutdown()
        listener.destroy_node()
        try_shutdown()


@contextmanager
def _nodes(namespace: str, agent: Path, output: Path) -> Iterator[subprocess.Popen[bytes]]:
    """Keep the robot's nodes and the sim for as long as the context lasts."""
    command = ['ros2', 'launch', 'hexapod_bringup', 'simulated_robot.launch.xml']
    arguments = [f'checkpoint:={agent}', f'namespace:={namespace}']
    with output.open('w') as file:
        process = subprocess.Popen([*command, *arguments], stdout=file, stderr=file)
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()


def table(heard: Mapping[str, Diagnosis]) -> Table:
    """Return a row per node."""
    made = Table('node', *_COLUMNS.values())
    for name in NODES:
        cells = [heard[name][key] for key in _COLUMNS]
        made.add_row(name, *cells[:-1], f'{float(cells[-1]):.2%}')
    return made


def verdict(heard: Mapping[str, Diagnosis]) -> tuple[bool, str]:
    """Say whether every node keeps the target, and what the machine did beside it."""
    worst = max(NODES, key=lambda name: float(heard[name]['late_share']))
    share = float(heard[worst]['late_share'])
    kept = share <= TARGET_SHARE
    load, cores = os.getloadavg()[0], os.cpu_count()
    return kept, (
        f'40 Hz {"held" if kept else "not held"}: {share:.2%} of the ticks of {worst} came more '
        f'than {LATE_NS / 1e6:g} ms late, expected at most {TARGET_SHARE:.0%}. The agent held the '
        f'robot {heard["play"]["holds"]} times. Load average {load:.1f} on {cores} cores.'
    )


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and print; the exit status is 0 if the target is kept."""
    parser = CommandLine(prog='realtime_report', description=__doc__)
    parser.add_argument('--seconds', type=number(gt=0), default=60.0, help='how long to measure')
    parser.add_argument('--checkpoint', type=file, help='agent; without one, an untrained one')
    parser.add_argument(
        '--observations', default='ABCDE', help='channels of an untrained agent (ABCDE)'
    )
    options = parser.parse_args(arguments)
    console = Console()
    with TemporaryDirectory(prefix='realtime_report_') as name:
        directory = Path(name)
        agent = options.checkpoint or directory / 'agent.pt'
        try:
            if options.checkpoint is None:
                trainer = Trainer(RunSpec.load().observing(options.observations), 1)
                checkpoint.save_agent(agent, trainer)
            agent_file.load(agent)  # what is wrong with it is better said before anything starts
            heard = measure(options.seconds, agent.resolve(), directory)
        except (ValueError, ReportError) as error:
            parser.error(str(error))
    console.print(table(heard))
    kept, text = verdict(heard)
    console.print(text)
    sys.exit(0 if kept else 1)


if __name__ == '__main__':
    main()
