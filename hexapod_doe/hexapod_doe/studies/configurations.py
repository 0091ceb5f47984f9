# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Study of the learner: train a table of configurations with sets of sensors and common seeds.

    python -m hexapod_doe.studies.configurations search.yaml --out runs/search

reads factors, rows, sets and seeds from a YAML file, trains each combination in a process of its
own, and appends to results.csv how its agent does without noise, from starts that no training has.
What is cut goes on from its checkpoint; what the table holds is not repeated.
"""

import argparse
import csv
import fcntl
import json
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from hexapod_agent.algorithms.policies import Policy, constant_policy
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.environment.evaluation import Evaluation, run_episode, summarize
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.provenance import provenance
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import ConfigError
from hexapod_agent.train import train_episode
from hexapod_cpg.mapping import ACTION_SIZE
from hexapod_sim.command_line import CommandLine, file, folder, whole

from hexapod_doe.studies.configuration_study import JUDGEMENT_SEED, Run, Study, letters_of
from hexapod_doe.studies.configuration_tables import effects, figures

RESULTS = 'results.csv'


class Training:
    """A run as it is trained, with its processor time and what was found of it so far."""

    def __init__(self, study: Study, run: Run, out: Path) -> None:
        self._study, self._run, self._out = study, run, out
        config = study.configuration(run.row).observing(letters_of(run.sensors))
        signs = run.row.replace('+', 'p').replace('-', 'm')
        self._path = out / f'{signs}_{run.sensors}_{run.seed}.pt'
        self._notes = self._path.with_suffix('.json')
        self._lines: list[dict[str, Any]] = []
        self._seconds = 0.0
        if self._notes.exists():
            self._trainer = checkpoint.load(self._path)
            notes = json.loads(self._notes.read_text())[str(self._trainer.episode)]
            self._lines, self._seconds = notes
        else:
            self._trainer = Trainer(config, run.seed)
        self._env = HexapodLine(config=config)

    def train(self) -> None:
        """Train to the end, and write the lines of the table and the agent."""
        trainer, study = self._trainer, self._study
        while trainer.episode < study.episodes:
            before = time.process_time()
            train_episode(self._env, trainer)
            self._seconds += time.process_time() - before
            if trainer.episode in (*study.judged_after, study.episodes):
                self._lines.append(self._line(self._judge()))
            if trainer.episode % trainer.config.training.checkpoint_every == 0:
                self._keep()
        _append(self._out / RESULTS, self._lines)
        checkpoint.save_agent(self._path, trainer)
        self._notes.unlink(missing_ok=True)

    def _keep(self) -> None:
        """Take a checkpoint; the notes know the one before as well, lest a crash part them."""
        old = json.loads(self._notes.read_text()) if self._notes.exists() else {}
        newest = {str(self._trainer.episode): (self._lines, self._seconds)}
        self._notes.write_text(json.dumps(dict(list(old.items())[-1:]) | newest))
        checkpoint.save(self._path, self._trainer)

    def _judge(self) -> Evaluation:
        env = HexapodLine(config=self._trainer.config)
        return _evaluation(env, self._trainer.learner.policy(), self._study.starts)

    def _line(self, found: Evaluation) -> dict[str, Any]:
        run, config = self._run, self._trainer.config
        values = {key: config.value(key) for key in self._study.keys}
        return {'row': run.row, **values, 'sensors': run.sensors, 'seed': run.seed} | {
            'episode': self._trainer.episode,
            'starts': found.starts,
            'return': round(found.final_average_reward, 1),
            'offset': round(found.mean_offset, 4),
            'speed': round(found.speed, 4),
            'falls': found.falls,
            'training_return': round(float(np.mean(self._trainer.returns[-20:])), 1),
            'cpu_s': round(self._seconds, 2),
            'commit': provenance()['git_commit'][:9],
        }


def _append(path: Path, lines: list[dict[str, Any]]) -> None:
    """Add lines to a table that other processes add to as well."""
    with path.open('a', newline='') as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        writer = csv.DictWriter(file, lines[0], lineterminator='\n')
        if not file.tell():
            writer.writeheader()
        writer.writerows(lines)
        file.flush()
        os.fsync(file.fileno())


def _held(path: Path, columns: Sequence[str]) -> set[Run]:
    """Runs whose lines the table holds.

    Raises:
        ConfigError: It is of another study.
    """
    if not path.exists():
        return set()
    with path.open(newline='') as file:
        reader = csv.DictReader(file)
        if list(reader.fieldnames or ()) != list(columns):
            raise ConfigError(f'{path}: expected a table of this study, with {", ".join(columns)}')
        return {Run(r['row'], r['sensors'], int(r['seed'])) for r in reader}


def main(args: Sequence[str] | None = None) -> None:
    """Train what is missing."""
    parser = _parser()
    options = parser.parse_args(args)
    try:
        study = Study.load(options.study)
        held = _held(options.out / RESULTS, study.columns)
    except ValueError as error:  # configuration or observations
        parser.error(str(error))
    options.out.mkdir(parents=True, exist_ok=True)
    missing = [number for number, run in enumerate(study.runs()) if run not in held]
    if options.only is not None:
        Training(study, study.runs()[options.only], options.out).train()
        return

    def start(number: int) -> None:
        command = [sys.executable, '-m', 'hexapod_doe.studies.configurations', options.study]
        arguments = ['--out', options.out, '--only', str(number)]
        subprocess.run([*command, *arguments], check=True)

    with ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(start, missing))
    _report(study, options.out / RESULTS)


def _report(study: Study, path: Path) -> None:
    """Print what the table says; an agent that earns less than the zero action has failed."""
    results = pd.read_csv(path, keep_default_na=False)
    zero = constant_policy(np.zeros(ACTION_SIZE, np.float32))
    env = HexapodLine('', study.configuration(study.rows[0]))
    failure = _evaluation(env, zero, study.starts).final_average_reward
    print(f'{path}; failed: less than {failure:.1f}, the zero action from the same starts')
    tables = [figures(results, failure)]
    if study.factors:
        tables.append(effects(results, list(study.factors)))
    for table in tables:
        print(table.to_string(index=False, float_format='{:.3f}'.format, na_rep=''))


def _evaluation(env: HexapodLine, policy: Policy, starts: int) -> Evaluation:
    return summarize([run_episode(env, policy, JUDGEMENT_SEED, start) for start in range(starts)])


def _parser() -> CommandLine:
    parser = CommandLine(prog='configurations', description=__doc__)
    parser.add_argument('study', type=file, help='YAML file: see docs/learning.md')
    parser.add_argument('--out', type=folder, required=True, help='directory of table and agents')
    parser.add_argument('--jobs', type=whole(1), default=2, help='runs side by side (default 2)')
    parser.add_argument(
        '--only', type=whole(0), help=argparse.SUPPRESS
    )  # one run, in this process
    return parser


if __name__ == '__main__':
    main()
