# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `train`: one run in the Gymnasium environment, without a node graph."""

import argparse
import csv
import math
import shlex
import sys
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

from hexapod_sim.command_line import MOST_EPISODES, MOST_SEED, CommandLine, folder, whole
from hexapod_sim.task import EVALUATION_SEED

from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.event_log import EventLog
from hexapod_agent.learning.numerics import check_precision, resolved, set_numerics
from hexapod_agent.learning.player import Agent
from hexapod_agent.learning.progress import Report, episode_report
from hexapod_agent.learning.run_checkpoint import different, listed
from hexapod_agent.learning.summary import EpisodeSummary
from hexapod_agent.learning.training import Trainer, TrainingDivergedError
from hexapod_agent.specification.run_spec import ConfigError, RunSpec
from hexapod_agent.specification.spec_text import add_spec_options

CHECKPOINT = 'checkpoint.pt'  # with the replay buffer: to resume
AGENT = 'agent.pt'  # the actor alone: to evaluate and to keep
LOG = 'episodes.csv'
EVALUATION = 'evaluation.csv'  # the same of the episodes without noise at the end
_EVALUATE = 'ros2 run hexapod_agent evaluate'
EVENTS = 'tensorboard'  # folder of the same curves, for `tensorboard --logdir`


def train_episode(env: HexapodLine, trainer: Trainer) -> EpisodeSummary:
    """Run and learn one episode, the trainer's next."""
    set_numerics(trainer.config.training.precision)
    return _run_episode(env, trainer, trainer.seed, trainer.episode)


def evaluate(env: HexapodLine, trainer: Trainer) -> Iterator[EpisodeSummary]:
    """Play the episodes of the run's evaluation; the last one's average return is their mean."""
    player = trainer.evaluator()
    while not player.is_done:
        env.task.enter(player.config.world)
        is_reported = player.is_reported
        summary = _run_episode(env, player, EVALUATION_SEED, player.start)
        if is_reported:
            yield summary


def _run_episode(env: HexapodLine, agent: Agent, seed: int, episode: int) -> EpisodeSummary:
    observation, _ = env.reset(seed=seed, options={'episode': episode})
    agent.begin_episode(episode)
    while True:
        action = agent.observe(observation, env.outcome)
        agent.learn()
        observation, _, terminated, truncated, _ = env.step(action)
        if terminated or truncated:
            return agent.end_episode(observation, env.outcome)


def train(
    trainer: Trainer,
    episodes: int,
    directory: Path,
    report: Report = lambda summary, evaluation=0: None,
) -> float:
    """Train until the run has so many episodes, with a log and checkpoints in a directory.

    Returns:
        Mean return of the evaluation that follows; NaN where there is none.

    Raises:
        OSError: The disk refuses.
        CheckpointError: Likewise.
        TrainingDivergedError: A number is no longer finite.
    """
    env = HexapodLine(trainer.spec.letters, trainer.config)
    directory.mkdir(parents=True, exist_ok=True)
    has_rows = _cut_log(directory / LOG, trainer.episode)
    with (
        (directory / LOG).open('a', newline='') as file,
        EventLog(directory / EVENTS, trainer.episode) as events,
    ):
        writer = csv.writer(file)
        while trainer.episode < episodes:
            summary = train_episode(env, trainer)
            columns = _columns(summary)
            if not has_rows:
                writer.writerow(columns)
                has_rows = True
            writer.writerow(columns.values())
            file.flush()
            events.add(summary)
            if trainer.episode % trainer.config.training.checkpoint_every == 0:
                checkpoint.save(directory / CHECKPOINT, trainer)
            report(summary)
    checkpoint.save(directory / CHECKPOINT, trainer)
    checkpoint.save_agent(directory / AGENT, trainer)
    return _evaluated(env, trainer, directory / EVALUATION, report)


def _evaluated(env: HexapodLine, trainer: Trainer, log: Path, report: Report) -> float:
    """Evaluate the run, and return the mean return."""
    evaluation = trainer.config.training.evaluation
    log.unlink(missing_ok=True)  # of the run when it was shorter
    mean = math.nan
    for summary in evaluate(env, trainer):
        columns = _columns(summary)
        with log.open('a', newline='') as file:
            writer = csv.DictWriter(file, columns)
            if not summary.episode:
                writer.writeheader()
            writer.writerow(columns)
        mean = summary.average_return
        report(summary, evaluation)
    return mean


def _columns(summary: EpisodeSummary) -> dict[str, Any]:
    """One row of the log: the summary with its metrics and terms spread out."""
    columns = dict(vars(summary))
    terms, metrics = columns.pop('terms'), columns.pop('metrics')
    return columns | metrics | {f'term_{name}': value for name, value in terms.items()}


def _cut_log(log: Path, episodes: int) -> bool:
    """Leave the header and the rows of the first episodes; return whether there are any."""
    if not (episodes and log.exists()):
        log.unlink(missing_ok=True)
        return False
    partial = log.with_name(f'{log.name}.partial')
    with log.open(newline='') as file, partial.open('w', newline='') as kept:
        kept.writelines(islice(file, episodes + 1))
    partial.replace(log)
    return log.stat().st_size > 0


def main(args: Sequence[str] | None = None) -> None:
    """Train as the command line says, then print the final average reward and the files."""
    parser = _parser()
    options = parser.parse_args(args)
    try:
        trainer = _trainer(options)
        episodes = _episodes(options, trainer)
        name = trainer.spec.letters or 'none'
        with episode_report(name, trainer.episode, episodes) as report:
            evaluation_return = train(trainer, episodes, options.out, report)
    except (ValueError, OSError, MemoryError) as error:  # configuration, checkpoint, disk, buffer
        parser.error(str(error))
    except TrainingDivergedError as error:
        sys.exit(f'train: {error}; {options.out / CHECKPOINT} is from before')
    except KeyboardInterrupt:
        print(f'train: interrupted; --resume goes on from {options.out / CHECKPOINT}, if any')
        sys.exit(130)
    print(f'final average reward {trainer.average_return:.1f}')
    if starts := trainer.config.training.evaluation:
        print(f'evaluation return {evaluation_return:.1f}, without noise, mean of {starts} starts')
    print(f'agent: {options.out / AGENT}')
    print(f'to resume: {options.out / CHECKPOINT}')
    print(f'next:\n  {_EVALUATE} {shlex.quote(str(options.out / AGENT))} --starts 50')


def _parser() -> CommandLine:
    parser = CommandLine(prog='train', description=__doc__)
    parser.add_argument('--observations', help='letters of the optional channels; default: none')
    parser.add_argument('--seed', type=whole(0, MOST_SEED), help='seed of the run (default 1)')
    parser.add_argument(
        '--episodes',
        type=whole(1, MOST_EPISODES),
        help="length of the run, with what it has had already; default of the run's configuration",
    )
    add_spec_options(parser)
    parser.add_argument(
        '--out', type=folder, required=True, help='directory of log and checkpoints'
    )
    parser.add_argument(
        '--resume',
        action='store_true',
        help='go on from the checkpoint in --out, whose observations, seed and configuration hold',
    )
    return parser


def _trainer(options: argparse.Namespace) -> Trainer:
    """A new run, or the one that the directory holds."""
    for setting in options.set if options.observations is not None else ():
        if setting.partition('=')[0].partition('.')[0] == 'observations':
            raise ConfigError(
                f'--observations {options.observations} and --set {setting}: expected one of them'
            )
    file = options.out / CHECKPOINT
    if options.resume:
        trainer = checkpoint.load(file)
        _check_same_run(options, trainer)
        trainer.config = _with_length(trainer.config, options.episodes)
        check_precision(trainer.config)
        return trainer
    if file.exists():
        raise ConfigError(f'{str(file)!r} exists, expected --resume or another --out')
    spec = _spec(options)
    check_precision(spec)
    return Trainer(spec, 1 if options.seed is None else options.seed)


def _spec(options: argparse.Namespace) -> RunSpec:
    """Return what the options ask for."""
    spec = _with_length(RunSpec.load(options.config, options.set), options.episodes)
    return spec if options.observations is None else spec.observing(options.observations)


def _with_length(spec: RunSpec, episodes: int | None) -> RunSpec:
    """Return a specification of a run of so many episodes; None changes nothing."""
    return spec if episodes is None else spec.with_value('training.episodes', episodes, 'episodes')


def _check_same_run(options: argparse.Namespace, trainer: Trainer) -> None:
    """Refuse options of another run than the one that goes on.

    Raises:
        ConfigError: One of them says otherwise than the checkpoint.
    """
    asked: RunSpec | None = None
    if options.config is not None or options.set:
        asked = resolved(RunSpec.load(options.config, options.set))
    if asked is None or not any(asked.observations.values()):  # neither says anything of them
        asked = (asked or trainer.config).observing(trainer.config.letters)
    if options.observations is not None:
        asked = asked.observing(options.observations)
    if options.episodes is not None:  # a run may become longer
        asked = _with_length(asked, trainer.config.training.episodes)
    differences = different(trainer, asked, options.seed)
    if differences:
        raise ConfigError(
            f'--resume: the run in {str(options.out)!r} is another: {listed(differences)}; '
            'expected the same or none, as what the checkpoint has holds'
        )


def _episodes(options: argparse.Namespace, trainer: Trainer) -> int:
    """Return the run's length.

    Raises:
        ConfigError: It is longer already.
    """
    episodes: int = options.episodes or trainer.config.training.episodes
    if episodes < trainer.episode:
        raise ConfigError(
            f'--episodes is {episodes}, but the run in {str(options.out)!r} has had '
            f'{trainer.episode}, expected at least as many'
        )
    return episodes


if __name__ == '__main__':
    main()
