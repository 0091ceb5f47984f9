# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Node `check_sensors`: holds the sensors of a live graph, or of a bag, against the contract."""

import json
import sys
from collections.abc import Sequence
from pathlib import Path

from hexapod_agent.contract.check import check_sensors
from hexapod_agent.contract.finding import Finding
from hexapod_agent.contract.report import SensorReport, TopicRow
from hexapod_agent.nodes.contract_check import listen_and_check
from hexapod_node.coroutines import start
from hexapod_node.node import Node
from hexapod_node.spin import run
from hexapod_sim.command_line import one_line
from rclpy.task import Future
from rich.console import Console, JustifyMethod
from rich.table import Table
from rich.text import Text

from hexapod_doe.bags.location import user_path
from hexapod_doe.contract.bag_evidence import bag_evidence
from hexapod_doe.contract.check_options import CheckOptions, parse
from hexapod_doe.errors import BagError

_ROS_ARGS = '--ros-args'
_STYLES = {'pass': 'green', 'warning': 'yellow', 'fault': 'bold red', 'note': 'dim'}
_RIGHT = ('Hz', 'lag ms')


class CheckSensorsNode(Node):
    """Listens to the topics of a set, prints what it found and ends.

    Attributes:
        exit_status: of the process: 0 if the sensors pass.
    """

    def __init__(self, options: CheckOptions) -> None:
        super().__init__('check_sensors')
        self.exit_status: int | None = None
        self._options = options
        checked = listen_and_check(
            self, options.spec, options.seconds, options.limits, options.reliable, options.wait
        )
        start(checked).add_done_callback(self._on_checked)

    def _on_checked(self, checked: Future) -> None:
        self.exit_status = 1
        self.exit_status = tell(checked.result(), self._options)


def tell(report: SensorReport, options: CheckOptions) -> int:
    """Print a report, and write it where the options say so; return the exit status."""
    text = json.dumps(report.as_dict(), indent=2, ensure_ascii=False)
    if options.json == '-':
        sys.stdout.write(f'{text}\n')
    else:
        show(report)
    if options.json not in ('', '-'):
        user_path(options.json).write_text(f'{text}\n', encoding='utf-8')
    return 0 if report.passed else 1


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; what follows `--ros-args` goes to the node."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    count = words.index(_ROS_ARGS) if _ROS_ARGS in words else len(words)
    options = parse(words[:count], words[count + 1 :])
    if options.bag is None:
        remaps = [word for pair in options.remaps.items() for word in ('-r', ':='.join(pair))]
        run(lambda: CheckSensorsNode(options), [_ROS_ARGS, *remaps, *words[count:]])
    else:
        sys.exit(_check_bag(options.bag, options))


def _check_bag(bag: Path, options: CheckOptions) -> int:
    """Return the exit status: 2, and a line, where the bag cannot be checked."""
    try:
        evidence = bag_evidence(bag, options.spec, options.remaps)
        report = check_sensors(options.spec, evidence, options.limits, options.reliable)
        return tell(report, options)
    except (BagError, OSError) as error:
        print(f'check_sensors: {one_line(error)}', file=sys.stderr)
        return 2


def show(report: SensorReport, console: Console | None = None) -> None:
    """Print a report."""
    console = console or Console(highlight=False)
    table = Table(box=None, pad_edge=False)
    for head in ('', 'channel', 'topic', 'Hz', 'lag ms', 'frame', ''):
        # Names are there to be copied: they stay whole.
        justify: JustifyMethod = 'right' if head in _RIGHT else 'left'
        table.add_column(head, justify=justify, no_wrap=head != 'channel', overflow='fold')
    for row in report.rows:
        table.add_row(*_cells(row))
    console.print(table)
    for finding in report.findings:
        console.print()
        console.print(_paragraph(finding))
    console.print()
    console.print(_verdict(report))


def _cells(row: TopicRow) -> list[Text]:
    words = [
        row.letter,
        row.channel,
        row.topic,
        '' if row.rate is None else f'{row.rate:.1f}',
        '' if row.lag is None else f'{1e3 * row.lag:.1f}',
        row.frame,
    ]
    return [*map(Text, words), Text(row.verdict, style=_STYLES[row.verdict])]


def _paragraph(finding: Finding) -> Text:
    return Text.assemble(
        (finding.level, _STYLES[finding.level]),
        f' {finding.topic}: ',
        (finding.field, 'bold'),
        f' {finding.found}\n  expected {finding.expected}\n  cure: {finding.cure}',
    )


def _verdict(report: SensorReport) -> Text:
    name = f'Sensors of {report.observations}' if report.observations else 'Sensors'
    if report.passed:
        return Text(f'{name}: pass', style=_STYLES['pass'])
    count = len(report.faults)
    return Text(f'{name}: {count} fault{"s" * (count > 1)}', style=_STYLES['fault'])


if __name__ == '__main__':
    main()
