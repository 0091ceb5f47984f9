# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `evaluate`: checkpoints, or a baseline, without noise from seeded starts."""

import argparse
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from hexapod_cpg.mapping import ACTION_SIZE
from hexapod_sim.command_line import MOST_SEED, CommandLine, file, output_file, whole
from rich.console import Console
from rich.progress import Progress, track
from rich.table import Table

from hexapod_agent.algorithms.policies import (
    Policy,
    constant_policy,
    random_policy,
)
from hexapod_agent.deployment import agent_file
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.environment.evaluation import (
    Episode,
    Evaluation,
    GraphError,
    run_episode,
    summarize,
)
from hexapod_agent.environment.open_loop import GENERATIONS, OpenLoopGait, best_open_loop
from hexapod_agent.evaluation_cells import Cell, add_cell_options, cells
from hexapod_agent.specification.run_spec import ConfigError, RunSpec
from hexapod_agent.specification.spec_text import add_spec_options

_ROWS = (
    ('final average reward', 'reward', 'final_average_reward', '.1f'),
    ('  standard deviation between starts', '±', 'return_deviation', '.1f'),
    ('mean |offset|, last 5 s (m)', 'm off', 'mean_offset', '.3f'),
    ('95th percentile of |offset| (m)', '', 'offset_95', '.3f'),
    ('speed along the line (m/s)', 'm/s', 'speed', '.3f'),
    ('  in the last 8 s (m/s)', '', 'late_speed', '.3f'),
    ('falls', 'falls', 'falls', 'd'),
    ('recovered', 'recov.', 'recovered', 'd'),
    ('energy per metre (J/m)', 'J/m', 'energy_per_metre', '.1f'),
)
"""Each figure: its name, its head in a table of cells (none: it is not there), field and form."""


_MEASURED = ('joint_states', 'joint_torques', 'line_offset')
_CHANGEABLE = ('scene', 'robot', 'task', 'quality', 'sensors')
"""Sections that an agent may meet otherwise than it was trained with."""


_SEARCHED = {'constant': 'best constant action', 'open-loop': 'best open-loop gait'}


@dataclass(frozen=True)
class _Subject:
    """Who is evaluated: a checkpoint, or a baseline where there is none."""

    checkpoint: Path | None
    name: str
    spec: RunSpec
    policy: Policy | None
    """None for a baseline that is found for each environment."""


def main(args: Sequence[str] | None = None) -> None:
    """Evaluate what the command line names, and print a table."""
    parser = _parser()
    options = parser.parse_args(args)
    if options.graph and not options.checkpoint:
        parser.error('--graph: expected a CHECKPOINT for the graph to play')
    if bool(options.checkpoint) == bool(options.policy):
        parser.error('expected either a CHECKPOINT or --policy')
    console = Console()
    try:
        subjects = list(_subjects(options))
        rows = [
            (subject, cell, _evaluated(subject, cell, options, console))
            for subject in subjects
            for cell in cells(subject.spec, options)
        ]
    except (ConfigError, agent_file.CheckpointError, GraphError) as error:
        parser.error(str(error))
    is_one = len(subjects) == 1 and not (options.grid or options.cell)
    console.print(_table(*rows[0]) if is_one else _table_of_cells(rows, options.starts))
    if options.json:
        found = [_plain(row) for row in rows]
        text = json.dumps(_plain_figures(rows[0][2]) if is_one else found, indent=2)
        try:
            options.json.write_text(f'{text}\n', encoding='utf-8')
        except OSError as error:
            parser.error(f'--json: {error}')


def _parser() -> CommandLine:
    parser = CommandLine(prog='evaluate', description=__doc__)
    parser.add_argument('checkpoint', nargs='*', type=file, help='files written by train')
    parser.add_argument(
        '--policy',
        choices=('zero', 'random', *_SEARCHED),
        help='a baseline instead; constant: the best constant action; open-loop: the best one '
        'with a frequency and a first phase of its own; both are searched for minutes',
    )
    add_spec_options(parser)
    add_cell_options(parser)
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


def _subjects(options: argparse.Namespace) -> Iterator[_Subject]:
    """Yield what the options ask for."""
    for path in options.checkpoint:
        agent = agent_file.load(path)
        spec = agent.config.changed_by(options.config) if options.config else agent.config
        spec = spec.with_settings(options.set)
        _check_same_agent(agent.config, spec)
        name = f'{agent.spec.letters or "no optional channel"}, {agent.episode} episodes'
        yield _Subject(path, name, spec, agent.policy)
    if options.policy:
        spec = RunSpec.load(options.config, options.set).observing('')
        name, policy = {
            'zero': ('zero action', constant_policy(np.zeros(ACTION_SIZE, np.float32))),
            'random': ('random actions', random_policy(options.seed)),
            **{policy: (name, None) for policy, name in _SEARCHED.items()},
        }[options.policy]
        yield _Subject(None, name, spec, policy)


def _check_same_agent(trained: RunSpec, spec: RunSpec) -> None:
    """Refuse changes of what made the agent."""
    for key in spec.differences(trained):
        if key.split('.')[0] not in _CHANGEABLE:
            raise ConfigError(
                f'{key}: a CHECKPOINT is as it was trained, expected keys of '
                f'{", ".join(_CHANGEABLE)}, or --policy'
            )


def _evaluated(
    subject: _Subject, cell: Cell, options: argparse.Namespace, console: Console
) -> Evaluation:
    """Evaluate in one cell; of a varied robot against the same agent with the robot as built."""
    if subject.checkpoint:
        _check_same_agent(subject.spec, cell.spec)
    speed = None
    if cell.spec.robot.variations:
        sound = cell.changed({'robot': asdict(cell.spec.robot.undamaged)})
        speed = summarize(_played(subject, sound, options, console)).late_speed
    return summarize(_played(subject, cell, options, console), speed)


def _played(
    subject: _Subject, cell: Cell, options: argparse.Namespace, console: Console
) -> list[Episode]:
    episodes = _episodes(subject, cell, options)
    name = f'{subject.name}{" " if cell.values else ""}{cell.text}'
    return list(track(episodes, name, options.starts, console=console, transient=True))


def _episodes(subject: _Subject, cell: Cell, options: argparse.Namespace) -> Iterator[Episode]:
    if options.graph and subject.checkpoint:
        _check_measured(cell.spec)
        return _on_graph(subject.checkpoint, cell.spec, options)
    policy, spec = subject.policy, cell.spec
    if policy is None:
        gait = _searched(spec, options.policy == 'open-loop')
        policy, spec = constant_policy(gait.action), gait.spec
    env = HexapodLine(config=spec)
    return (run_episode(env, policy, options.seed, start) for start in range(options.starts))


def _searched(spec: RunSpec, rhythm: bool) -> OpenLoopGait:
    with Progress(transient=True) as progress:
        task = progress.add_task('search', total=GENERATIONS)
        return best_open_loop(spec, rhythm, lambda generation: progress.advance(task))


def _check_measured(spec: RunSpec) -> None:
    """Refuse to measure by sensors that are not perfect."""
    bad = [key for key in _MEASURED if not spec.sensors[key].perfect]
    if bad:
        raise GraphError(
            f'--graph: figures are measured by the topics of {", ".join(bad)}, whose errors the '
            'specification asks for; expected perfect ones, or no --graph'
        )


def _on_graph(checkpoint: Path, spec: RunSpec, options: argparse.Namespace) -> Iterator[Episode]:
    # Only here: without --graph, evaluating needs no ROS.
    from hexapod_agent.nodes.evaluate_node import episodes_on_graph

    values = spec.to_mapping()
    changes = {section: values[section] for section in _CHANGEABLE}
    return episodes_on_graph(checkpoint, options.starts, options.seed, changes)


def _table(subject: _Subject, cell: Cell, evaluation: Evaluation) -> Table:
    table = Table('figure', 'value', title=f'{subject.name}, {evaluation.starts} starts')
    for label, _, field, form in _ROWS:
        if (value := getattr(evaluation, field)) is not None:
            table.add_row(label, format(value, form))
    return table


def _table_of_cells(rows: Sequence[tuple[_Subject, Cell, Evaluation]], starts: int) -> Table:
    """Return a table of a row for each agent in each cell."""
    names = [str(subject.checkpoint or subject.name) for subject, _, _ in rows]
    is_one = len(set(names)) == 1
    table = Table(title=f'{names[0] if is_one else "agents"}, {starts} starts each')
    for head in ('with',) if is_one else ('agent', 'with'):
        table.add_column(head, overflow='fold')
    shown = [(head, field, form) for _, head, field, form in _ROWS if head]
    for head, _, _ in shown:
        table.add_column(head, justify='right', no_wrap=True)
    for name, (_, cell, evaluation) in zip(names, rows, strict=True):
        found = [(getattr(evaluation, field), form) for _, field, form in shown]
        figures = ['' if value is None else format(value, form) for value, form in found]
        labels = [cell.text.replace(' ', '\n')]
        table.add_row(*(labels if is_one else [name, *labels]), *figures)
    return table


def _plain(row: tuple[_Subject, Cell, Evaluation]) -> dict[str, Any]:
    """Return a row of many as JSON can hold it, what is met by its keys."""
    subject, cell, evaluation = row
    agent = {'agent': str(subject.checkpoint or subject.name)}
    return agent | dict(cell.values) | _plain_figures(evaluation)


def _plain_figures(evaluation: Evaluation) -> dict[str, float | None]:
    """Return figures as JSON can hold them: NaN becomes null."""
    figures: Mapping[str, Any] = asdict(evaluation)
    return {
        key: None if value is None or math.isnan(value) else value
        for key, value in figures.items()
    }


if __name__ == '__main__':
    main()
