# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `evaluate`: a checkpoint, or a baseline, without noise from seeded starts."""

import argparse
import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict

import numpy as np
from hexapod_cpg.mapping import ACTION_SIZE
from hexapod_sim.command_line import MOST_SEED, CommandLine, file, output_file, whole
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import Progress, track
from rich.table import Table

from hexapod_agent.algorithms.policies import (
    Policy,
    constant_policy,
    random_policy,
)
from hexapod_agent.deployment import agent_file
from hexapod_agent.environment.constant_action import GENERATIONS, best_constant_action
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.environment.evaluation import (
    Episode,
    Evaluation,
    GraphError,
    run_episode,
    summarize,
)
from hexapod_agent.specification.run_spec import ConfigError, RunSpec
from hexapod_agent.specification.spec_text import add_spec_options

_ROWS = (
    ('final average reward', 'final_average_reward', '.1f'),
    ('  standard deviation between starts', 'return_deviation', '.1f'),
    ('mean |offset|, last 5 s (m)', 'mean_offset', '.3f'),
    ('95th percentile of |offset| (m)', 'offset_95', '.3f'),
    ('speed along the line (m/s)', 'speed', '.3f'),
    ('falls', 'falls', 'd'),
    ('energy per metre (J/m)', 'energy_per_metre', '.1f'),
)


_MEASURED = ('joint_states', 'joint_torques', 'line_offset')


def main(args: Sequence[str] | None = None) -> None:
    """Evaluate what the command line names, and print a table."""
    parser = _parser()
    options = parser.parse_args(args)
    if options.graph and not options.checkpoint:
        parser.error('--graph: expected a CHECKPOINT for the graph to play')
    if bool(options.checkpoint) == bool(options.policy):
        parser.error('expected either a CHECKPOINT or --policy')
    if options.checkpoint and (options.config or options.set):
        parser.error('--config: a CHECKPOINT has its own, expected it with --policy only')
    try:
        name, subject = _subject(options)
        console = Console()
        episodes = list(track(subject, name, options.starts, console=console, transient=True))
    except (ConfigError, agent_file.CheckpointError, GraphError) as error:
        parser.error(str(error))
    evaluation = summarize(episodes)
    console.print(_table(name, evaluation))
    if options.json:
        text = json.dumps(_plain(evaluation), indent=2)
        try:
            options.json.write_text(f'{text}\n', encoding='utf-8')
        except OSError as error:
            parser.error(f'--json: {error}')


def _parser() -> CommandLine:
    parser = CommandLine(prog='evaluate', description=__doc__)
    parser.add_argument('checkpoint', nargs='?', type=file, help='file written by train')
    parser.add_argument(
        '--policy',
        choices=('zero', 'random', 'constant'),
        help='a baseline instead; constant: the best constant action, searched for minutes',
    )
    add_spec_options(parser)
    parser.add_argument(
        '--starts', type=whole(1, 1_000_000), default=50, help='episodes (default 50)'
    )
    parser.add_argument(
        '--seed', type=whole(0, MOST_SEED), default=1, help='seed of the starts (default 1)'
    )
    parser.add_argument(
        '--graph',
        action='store_true',
        help='play through the nodes sim, cpg and agent and their topics, started here in a '
        'namespace of their own; the figures are the same to the last bit',
    )
    parser.add_argument(
        '--json', type=output_file(), metavar='FILE', help='write the figures to a file as well'
    )
    return parser


def _subject(options: argparse.Namespace) -> tuple[str, Iterator[Episode]]:
    """Name of what the options ask for, and its episodes."""
    if options.checkpoint:
        agent = agent_file.load(options.checkpoint)
        letters = agent.spec.letters
        name = f'{letters or "no optional channel"}, {agent.episode} episodes'
        if options.graph:
            _check_measured(agent.config)
            return name, _on_graph(options)
        return name, _in_environment(HexapodLine(config=agent.config), agent.policy, options)
    env = HexapodLine('', RunSpec.load(options.config, options.set))
    if options.policy == 'random':
        return 'random actions', _in_environment(env, random_policy(options.seed), options)
    if options.policy == 'constant':
        best = constant_policy(_searched(env))
        return 'best constant action', _in_environment(env, best, options)
    zero = constant_policy(np.zeros(ACTION_SIZE, np.float32))
    return 'zero action', _in_environment(env, zero, options)


def _searched(env: HexapodLine) -> NDArray[np.float32]:
    with Progress(transient=True) as progress:
        task = progress.add_task('search', total=GENERATIONS)
        return best_constant_action(env, lambda generation: progress.advance(task))


def _in_environment(
    env: HexapodLine, policy: Policy, options: argparse.Namespace
) -> Iterator[Episode]:
    return (run_episode(env, policy, options.seed, start) for start in range(options.starts))


def _check_measured(spec: RunSpec) -> None:
    """Refuse to measure by sensors that are not perfect."""
    bad = [key for key in _MEASURED if not spec.sensors[key].perfect]
    if bad:
        raise GraphError(
            f'--graph: figures are measured by the topics of {", ".join(bad)}, whose errors the '
            'specification asks for; expected perfect ones, or no --graph'
        )


def _on_graph(options: argparse.Namespace) -> Iterator[Episode]:
    # Only here: without --graph, evaluating needs no ROS.
    from hexapod_agent.nodes.evaluate_node import episodes_on_graph

    return episodes_on_graph(options.checkpoint, options.starts, options.seed)


def _table(name: str, evaluation: Evaluation) -> Table:
    table = Table('figure', 'value', title=f'{name}, {evaluation.starts} starts')
    for label, field, form in _ROWS:
        table.add_row(label, format(getattr(evaluation, field), form))
    return table


def _plain(evaluation: Evaluation) -> dict[str, float | None]:
    """Figures as JSON can hold them: NaN becomes null."""
    return {key: None if math.isnan(value) else value for key, value in asdict(evaluation).items()}


if __name__ == '__main__':
    main()
