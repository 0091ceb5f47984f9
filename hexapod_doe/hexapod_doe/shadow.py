# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `shadow`: an agent on recorded sensors, its actions beside the recorded ones."""

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import asdict

from hexapod_agent.deployment.agent_file import CheckpointError, load
from hexapod_sim.command_line import CommandLine, file, one_line, output_file, path, whole
from rich.console import Console
from rich.table import Table

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.errors import BagError
from hexapod_doe.replays.episodes import episode_of, recorded_episodes
from hexapod_doe.replays.shadowing import Comparison, Difference, Recorded, shadow


def main(arguments: Sequence[str] | None = None) -> None:
    """Compare, print a table, and end with status 1 unless all is equal to the last bit."""
    parser = _parser()
    options = parser.parse_args(arguments)
    try:
        found = _compare(options)
    except (BagError, CheckpointError, OSError) as error:
        parser.error(one_line(error))
    console = Console()
    for comparison in found:
        console.print(_table(comparison))
    if options.json:
        text = json.dumps([asdict(comparison) for comparison in found], indent=2)
        options.json.write_text(f'{text}\n', encoding='utf-8')
    sys.exit(any(comparison.equal < comparison.periods for comparison in found))


def _parser() -> CommandLine:
    parser = CommandLine(prog='shadow', description=__doc__)
    parser.add_argument('bag', type=path, help='directory of a bag with all topics of an episode')
    parser.add_argument(
        '--checkpoint', required=True, type=file, help='agent to show it to: a file of train'
    )
    parser.add_argument(
        '--episode', type=whole(ge=0), help='number of one episode; default: all recorded'
    )
    parser.add_argument(
        '--graph',
        action='store_true',
        help='show it to the agent node, through its topics, started here in a namespace of its '
        'own; an agent that differs goes on from its own actions there',
    )
    parser.add_argument(
        '--json', type=output_file(), metavar='FILE', help='write the figures to a file as well'
    )
    return parser


def _compare(options: argparse.Namespace) -> list[Comparison]:
    if options.graph:
        # Only here: without --graph, comparing needs no nodes.
        from hexapod_doe.nodes.shadow_node import shadow_on_graph

        return shadow_on_graph(options.bag, options.checkpoint, options.episode)
    bag, agent = BagFile(options.bag), load(options.checkpoint)
    recorded = Recorded(bag, agent.spec)
    spans = recorded_episodes(bag, recorded.commands)
    if options.episode is not None:
        spans = [episode_of(options.episode, spans, bag)]
    return [shadow(recorded, span, agent.policy, agent.config.cpg) for span in spans]


def _table(row: Comparison) -> Table:
    table = Table('figure', 'value', title=f'episode {row.episode}', title_justify='left')
    table.add_row('periods compared', str(row.periods))
    table.add_row('  equal to the last bit', str(row.equal))
    table.add_row('  with a sensor older than the command', str(row.aged))
    table.add_row('first difference', _told(row.first))
    table.add_row('largest difference', _told(row.largest))
    return table


def _told(difference: Difference | None) -> str:
    if difference is None:
        return 'none'
    return (
        f'{difference.size:.2g} in {difference.field}: {difference.shadow:.6g} '
        f'instead of {difference.recorded:.6g}\n'
        f'in period {difference.period}, at {difference.stamp_ns * 1e-9:.3f} s'
    )


if __name__ == '__main__':
    main()
