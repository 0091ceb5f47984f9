# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `train`: one run in the Gymnasium environment, without a node graph."""

import argparse
import csv
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from hexapod_agent import checkpoint
from hexapod_agent.config import AgentConfig, ConfigError
from hexapod_agent.env import HexapodLine
from hexapod_agent.event_log import EventLog
from hexapod_agent.observation import ObservationSpec
from hexapod_agent.summary import EpisodeSummary
from hexapod_agent.training import Trainer, TrainingDivergedError

CHECKPOINT = 'checkpoint.pt'  # with the replay buffer: to resume
AGENT = 'agent.pt'  # the actor alone: to evaluate and to keep
LOG = 'episodes.csv'
EVENTS = 'tensorboard'  # folder of the same curves, for `tensorboard --logdir`


def train_episode(env: HexapodLine, trainer: Trainer) -> EpisodeSummary:
    """Run and learn one episode, the trainer's next."""
    observation, _ = env.reset(seed=trainer.seed, options={'episode': trainer.episode})
    trainer.begin_episode(trainer.episode)
    while True:
        action = trainer.observe(observation, env.outcome)
        trainer.learn()
        observation, _, terminated, truncated, _ = env.step(action)
        if terminated or truncated:
            return trainer.end_episode(observation, env.outcome)


def train(
    trainer: Trainer,
    episodes: int,
    directory: Path,
    report: Callable[[EpisodeSummary], None] = lambda summary: None,
) -> None:
    """Train until the run has so many episodes, with a log and checkpoints in a directory."""
    env = HexapodLine(trainer.spec.letters, trainer.config)
    directory.mkdir(parents=True, exist_ok=True)
    rows = _kept_rows(directory / LOG, trainer.episode)
    with (
        (directory / LOG).open('w', newline='') as file,
        EventLog(directory / EVENTS, trainer.episode) as events,
    ):
        writer = csv.writer(file)
        for row in rows:
            writer.writerow(row)
        while trainer.episode < episodes:
            summary = train_episode(env, trainer)
            columns = _columns(summary)
            if summary.episode == 0:
                writer.writerow(columns)
            writer.writerow(columns.values())
            file.flush()
            events.add(summary)
            if trainer.episode % trainer.config.training.checkpoint_every == 0:
                checkpoint.save(directory / CHECKPOINT, trainer, to_resume=True)
            report(summary)
    checkpoint.save(directory / CHECKPOINT, trainer, to_resume=True)
    checkpoint.save(directory / AGENT, trainer, to_resume=False)


def _columns(summary: EpisodeSummary) -> dict[str, Any]:
    """One row of the log: the summary with its terms spread out."""
    columns = dict(vars(summary))
    terms = columns.pop('terms')
    return columns | {f'term_{name}': value for name, value in terms.items()}


def _kept_rows(path: Path, episodes: int) -> list[list[str]]:
    """Header and rows of the episodes that a resumed run does not repeat."""
    if not episodes:
        return []
    with path.open(newline='') as file:
        return list(csv.reader(file))[: episodes + 1]


def main(args: Sequence[str] | None = None) -> None:
    """Train as the command line says, then print the final average reward and the files."""
    parser = _parser()
    options = parser.parse_args(args)
    try:
        trainer = _trainer(options)
    except ValueError as error:  # configuration, observations or checkpoint
        parser.error(str(error))
    episodes = options.episodes or trainer.config.training.episodes
    console = Console()
    progress = Progress(
        TextColumn('{task.description}'), BarColumn(), MofNCompleteColumn(),
        TimeRemainingColumn(), TextColumn('{task.fields[status]}'), console=console,
    )  # fmt: skip
    with progress:
        task = progress.add_task(
            trainer.spec.letters or 'none', total=episodes, completed=trainer.episode, status=''
        )

        def report(summary: EpisodeSummary) -> None:
            progress.update(
                task,
                completed=summary.episode + 1,
                status=f'return {summary.episode_return:.0f}, mean {summary.average_return:.0f}, '
                f'saturated {summary.saturated_share:.0%}',
            )

        try:
            train(trainer, episodes, options.out, report)
        except TrainingDivergedError as error:
            progress.stop()
            sys.exit(f'train: {error}; {options.out / CHECKPOINT} is from before')
    console.print(f'final average reward {trainer.average_return:.1f}')
    console.print(f'agent: {options.out / AGENT}')
    console.print(f'to resume: {options.out / CHECKPOINT}')


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog='train', description=__doc__)
    parser.add_argument('--observations', default='', help='letters of the optional channels')
    parser.add_argument('--seed', type=int, default=1, help='seed of the run (default 1)')
    parser.add_argument('--episodes', type=int, help='length of the run; default of the config')
    parser.add_argument('--config', help='YAML file of changes to article.yaml')
    parser.add_argument('--out', type=Path, required=True, help='directory of log and checkpoints')
    parser.add_argument('--resume', action='store_true', help='go on from the checkpoint in --out')
    return parser


def _trainer(options: argparse.Namespace) -> Trainer:
    """A new run, or the one that the directory holds."""
    path = options.out / CHECKPOINT
    if options.resume:
        return checkpoint.load(path, to_resume=True)
    if path.exists():
        raise ConfigError(f'{str(path)!r} exists, expected --resume or another --out')
    config = AgentConfig.load(options.config)
    return Trainer(ObservationSpec(options.observations), config, options.seed)


if __name__ == '__main__':
    main()
