# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Study of the learning itself: does the agent learn the task within its budget, in every seed?

    python -m hexapod_doe.studies.learning --out runs/learning

trains sets of sensors with several seeds, evaluates each agent from the same starts as the
baselines, and leaves table.csv and curves.png. What a directory already holds is not repeated.
With several configurations it compares them, so algorithms too.
"""

import json
import math
import os
import subprocess
import sys
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import pandas as pd
from hexapod_agent.train import AGENT, CHECKPOINT, EVALUATION, LOG
from hexapod_sim.command_line import CommandLine, file, folder, whole
from matplotlib.axes import Axes

from hexapod_doe.reporting.figures.learning import outliers
from hexapod_doe.reporting.figures.parts import grid
from hexapod_doe.reporting.figures.style import BLUE, INK, MUTED, ORANGE, RC

FIGURES = 'evaluation.json'
BASELINES = {
    'zero': 'zero action',
    'constant': 'constant action',
    'open-loop': 'open-loop gait',
}
COLUMNS = (
    'final_average_reward',
    'mean_offset',
    'offset_95',
    'speed',
    'falls',
    'energy_per_metre',
)
RUN_COLUMNS = ('evaluation_return', 'steps', 'processor_seconds')
PROCESSOR = 'processor.json'
"""Processor time of each command that trained a run: one, unless it was resumed."""
_SMOOTHING = 10
"""Episodes of the moving average: start offsets alone scatter single returns by hundreds."""


@dataclass(frozen=True)
class Training:
    """One run of the study."""

    letters: str
    seed: int
    episodes: int
    directory: Path
    config: Path | None
    label: str

    def train(self) -> None:
        """Train it, from its checkpoint if it has one."""
        log = self.directory / LOG
        if (self.directory / AGENT).exists() and len(pd.read_csv(log)) >= self.episodes:
            return
        changes = ['--config', str(self.config)] if self.config else []
        resume = ['--resume'] if (self.directory / CHECKPOINT).exists() else []
        seconds = _python(
            'hexapod_agent.train', '--observations', self.letters, '--seed', str(self.seed),
            '--episodes', str(self.episodes), '--out', str(self.directory), *changes, *resume,
        )  # fmt: skip
        (self.directory / PROCESSOR).write_text(json.dumps([*self._processor(), seconds]))

    def outcome(self) -> dict[str, float]:
        """Return the mean return of its own evaluation, its steps, and its processor time.

        That time is not known of a run that was cut before it said so.
        """
        returns = pd.read_csv(self.directory / EVALUATION)['episode_return']
        seconds = self._processor()
        known = len(seconds) > 0
        steps = pd.read_csv(self.directory / LOG)['steps'].sum()
        values = (returns.mean(), steps, sum(seconds) if known else math.nan)
        return dict(zip(RUN_COLUMNS, values, strict=True))

    def _processor(self) -> list[float]:
        file = self.directory / PROCESSOR
        found: list[float] = json.loads(file.read_text()) if file.exists() else []
        return found

    def evaluate(self, starts: int) -> dict[str, float]:
        """Return the figures of its agent, without noise."""
        return _figures(self.directory / FIGURES, starts, str(self.directory / AGENT))

    def curve(self) -> pd.DataFrame:
        """Return the returns of its episodes."""
        columns = ['episode', 'episode_return', 'average_return']
        return pd.read_csv(self.directory / LOG)[columns].assign(
            observations=self.label, seed=self.seed
        )


def _python(module: str, *arguments: str) -> float:
    """Run a module and return the processor time that it took, in seconds."""
    command = [sys.executable, '-m', module, *arguments]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as child:
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        raise subprocess.CalledProcessError(child.returncode, command)
    return usage.ru_utime + usage.ru_stime


def _figures(file: Path, starts: int, *subject: str) -> dict[str, float]:
    """Read what `evaluate` found, after calling it where that is missing or out of date."""
    if not _is_current(file, starts, Path(subject[0])):
        _python('hexapod_agent.evaluate', *subject, '--starts', str(starts), '--json', str(file))
    figures: dict[str, float] = json.loads(file.read_text())
    return figures


def _is_current(file: Path, starts: int, agent: Path) -> bool:
    if not file.exists() or json.loads(file.read_text())['starts'] != starts:
        return False
    return not agent.exists() or file.stat().st_mtime >= agent.stat().st_mtime


def table(
    baselines: dict[str, dict[str, float]], runs: Iterable[tuple[Training, dict[str, float]]]
) -> pd.DataFrame:
    """Return one row per agent; `gain` is the reward over that of the best constant action."""
    best = baselines['constant']['final_average_reward']
    rows = [{'agent': BASELINES[name], **figures} for name, figures in baselines.items()]
    rows += [
        {'agent': run.label, 'seed': run.seed, 'episodes': run.episodes, **figures}
        for run, figures in runs
    ]
    frame = pd.DataFrame(rows)
    frame['gain'] = frame['final_average_reward'] / best - 1.0
    names = ['agent', 'seed', 'episodes', *COLUMNS, 'gain', *RUN_COLUMNS]
    whole_numbers = ('seed', 'episodes', 'steps', 'falls')
    return frame.reindex(columns=names).astype(dict.fromkeys(whole_numbers, 'Int64'))


def main(args: Sequence[str] | None = None) -> None:
    """Train, evaluate and tabulate."""
    options = _parser().parse_args(args)
    options.out.mkdir(parents=True, exist_ok=True)
    configs: list[Path | None] = options.config or [None]
    runs = [
        Training(
            '' if name == 'none' else name, seed, options.episodes,
            options.out / f'{label.replace(": ", "_")}_{seed}', config, label,
        )
        for config in configs
        for name in options.sets
        for label in [f'{config.stem}: {name}' if config and len(configs) > 1 else name]
        for seed in range(options.first_seed, options.first_seed + options.seeds)
    ]  # fmt: skip
    changes = ['--config', str(configs[0])] if configs[0] else []
    with ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(Training.train, runs))
        baselines = pool.map(
            lambda name: _figures(
                options.out / f'{name}.json', options.starts, '--policy', name, *changes
            ),
            BASELINES,
        )
        figures = list(pool.map(lambda run: run.evaluate(options.starts) | run.outcome(), runs))
    found = table(dict(zip(BASELINES, baselines, strict=True)), zip(runs, figures, strict=True))
    found.to_csv(options.out / 'table.csv', index=False, lineterminator='\n')
    best = found.loc[found['agent'] == 'constant action', 'final_average_reward'].item()
    draw(pd.concat([run.curve() for run in runs]), best, options.out / 'curves.png')
    print(found.to_string(index=False, float_format='{:.3f}'.format, na_rep=''))


def _parser() -> CommandLine:
    parser = CommandLine(prog='learning', description=__doc__)
    parser.add_argument('--out', type=folder, required=True, help='directory of runs and results')
    parser.add_argument(
        '--sets', nargs='+', default=['ABCDE', 'none'], help='sets of sensors (ABCDE and none)'
    )
    parser.add_argument(
        '--seeds', type=whole(ge=1), default=5, help='runs of each set (default 5)'
    )
    parser.add_argument(
        '--first-seed', type=whole(ge=0), default=1, metavar='N', help='of each set (default 1)'
    )
    parser.add_argument('--episodes', type=whole(ge=1), default=300, help='per run (default 300)')
    parser.add_argument(
        '--starts', type=whole(ge=1), default=50, help='of an evaluation (default 50)'
    )
    parser.add_argument(
        '--config', type=file, nargs='+', help='YAML file of changes to article.yaml; of several, '
        'each is trained, and the first one has the task of the baselines',
    )  # fmt: skip
    parser.add_argument(
        '--jobs', type=whole(ge=1), default=2, help='runs side by side (default 2)'
    )
    return parser


def draw(curves: pd.DataFrame, constant: float, path: Path) -> None:
    """Draw a panel for each set of sensors.

    Args:
        curves: Columns observations, seed, episode and episode_return.
        constant: Mean return of the best constant action, drawn as a line.
        path: PNG file to write.
    """
    sets = list(curves['observations'].unique())
    with mpl.rc_context(RC):
        figure, panels = grid(len(sets), len(sets), 2.2)
        for axes, name in zip(panels, sets, strict=True):
            _draw_set(axes, curves[curves['observations'] == name])
            axes.axhline(constant, color=ORANGE, linestyle='--', linewidth=1.0)
            title = name if ':' in name else f'with {name}'
            axes.set_title('always-on sensors alone' if name == 'none' else title)
            axes.set_xlabel('episode')
        panels[0].annotate(
            'best constant action', (1.0, constant), (0, -4), xycoords=('axes fraction', 'data'),
            textcoords='offset points', color=ORANGE, ha='right', va='top', fontsize=8,
        )  # fmt: skip
        panels[0].set_ylabel(f'return, mean of {_SMOOTHING} episodes')
        figure.savefig(path, dpi=160)


def _draw_set(axes: Axes, curves: pd.DataFrame) -> None:
    """Draw the runs of a set, their mean, and the name of a run that ends far from the others."""
    returns = curves.pivot_table(index='episode', columns='seed', values='episode_return')
    smooth = returns.rolling(_SMOOTHING, min_periods=1).mean()
    axes.plot(smooth.index, smooth, color=MUTED, linewidth=0.7, alpha=0.8)
    axes.plot(smooth.index, smooth.mean(axis=1, skipna=False), color=BLUE, linewidth=2.0)
    ends = smooth.ffill().iloc[-1]
    for seed in outliers(ends):
        axes.annotate(
            f'seed {seed}', (smooth.index[-1], ends[seed]), (-3, 0), textcoords='offset points',
            ha='right', va='center', fontsize=8, color=INK,
        )  # fmt: skip


if __name__ == '__main__':
    main()
