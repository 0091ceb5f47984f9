# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `evaluate`: a checkpoint, or a baseline, without noise from seeded starts."""

import argparse
import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
from hexapod_cpg.mapping import ACTION_SIZE
from rich.console import Console
from rich.progress import track
from rich.table import Table

from hexapod_agent import checkpoint
from hexapod_agent.config import AgentConfig, ConfigError
from hexapod_agent.env import HexapodLine
from hexapod_agent.evaluation import Evaluation, run_episode, summarize
from hexapod_agent.policies import Policy, constant_policy, random_policy, trained_policy

_ROWS = (
    ('final average reward', 'final_average_reward', '.1f'),
    ('  standard deviation between starts', 'return_deviation', '.1f'),
    ('mean |offset|, last 5 s (m)', 'mean_offset', '.3f'),
    ('95th percentile of |offset| (m)', 'offset_95', '.3f'),
    ('speed along the line (m/s)', 'speed', '.3f'),
    ('falls', 'falls', 'd'),
    ('energy per metre (J/m)', 'energy_per_metre', '.1f'),
)


def main(args: Sequence[str] | None = None) -> None:
    """Evaluate what the command line names, and print a table."""
    parser = _parser()
    options = parser.parse_args(args)
    if bool(options.checkpoint) == bool(options.policy):
        parser.error('expected either a CHECKPOINT or --policy')
    try:
        name, env, policy = _subject(options)
    except (ConfigError, checkpoint.CheckpointError) as error:
        parser.error(str(error))
    console = Console()
    episodes = [
        run_episode(env, policy, options.seed, start)
        for start in track(range(options.starts), name, console=console, transient=True)
    ]
    evaluation = summarize(episodes)
    console.print(_table(name, evaluation))
    if options.json:
        Path(options.json).write_text(json.dumps(_plain(evaluation), indent=2) + '\n')


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog='evaluate', description=__doc__)
    parser.add_argument('checkpoint', nargs='?', help='file written by train')
    parser.add_argument('--policy', choices=('zero', 'random'), help='a baseline instead')
    parser.add_argument('--config', help='configuration of the baseline; default article.yaml')
    parser.add_argument('--starts', type=int, default=50, help='episodes (default 50)')
    parser.add_argument('--seed', type=int, default=1, help='seed of the starts (default 1)')
    parser.add_argument('--json', metavar='FILE', help='write the figures to a file as well')
    return parser


def _subject(options: argparse.Namespace) -> tuple[str, HexapodLine, Policy]:
    """Name, environment and policy that the options ask for."""
    if options.checkpoint:
        trainer = checkpoint.load(options.checkpoint)
        letters = trainer.spec.letters
        name = f'{letters or "no optional channel"}, {trainer.episode} episodes'
        return name, HexapodLine(letters, trainer.config), trained_policy(trainer.agent)
    env = HexapodLine('', AgentConfig.load(options.config))
    if options.policy == 'random':
        return 'random actions', env, random_policy(options.seed)
    return 'zero action', env, constant_policy(np.zeros(ACTION_SIZE, np.float32))


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
