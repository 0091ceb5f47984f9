# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Runs what is missing of a study: the campaigns of a folder, and the confirmation of the first.

    python -m hexapod_doe.studies.run_study bags/study

says how many hours it may take, then trains each campaign on live workers. Interrupted at any
time, the same command goes on from each run's last checkpoint.
"""

import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from hexapod_sim.command_line import CommandLine, folder, one_line, whole

from hexapod_doe import plan as plan_command
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.forecast import seconds_of
from hexapod_doe.campaigns.next_steps import CONFIRM_FOLDER
from hexapod_doe.campaigns.progress import Progress, State
from hexapod_doe.campaigns.row import read_rows
from hexapod_doe.cores import usable_cores
from hexapod_doe.errors import AnalysisError, BagError, TableError
from hexapod_doe.fitting.model import EMPTY_SET
from hexapod_doe.records.options import Options
from hexapod_doe.tables.bag_table import plan_rule, read_bags

MAIN = 'main'
"""The campaign that is run first, and whose choice is confirmed."""
CONFIRMING_RUNS = 10
"""New runs of each set."""
ALWAYS_CONFIRMED = ('ABCDE', 'ABCDEFG', EMPTY_SET)
"""Sets that are confirmed whatever the choice is: the article's best, all, none."""
_HOUR_S = 3600.0


@dataclass(frozen=True)
class Part:
    """One campaign of the study."""

    folder: Path
    progress: Progress

    @classmethod
    def read(cls, folder: Path) -> 'Part':
        """Read how far a campaign is from its folder."""
        return cls(folder, read_progress(folder))

    @property
    def left(self) -> int:
        """Runs that are not done; none once its rule has ended the campaign."""
        if self.progress.complete:
            return 0
        return len(self.progress.runs) - len(self.progress.having(State.DONE))

    @property
    def seconds_per_run(self) -> float:
        """Time of a run on one worker: as its own runs took, or else by its learner's updates."""
        done = self.progress.having(State.DONE)
        rates = [run.episodes_per_second for run in done if run.episodes_per_second > 0]
        spec = read_rows(self.folder / PLAN_FILE)[0].spec
        if rates:
            return spec.training.episodes * len(rates) / sum(rates)
        return seconds_of(spec)

    @property
    def measured(self) -> bool:
        """Whether runs of its own tell the time."""
        return bool(self.progress.having(State.DONE))


def parts_of(study: Path) -> list[Part]:
    """Return the campaigns of a study, the main one first and each before its confirmation.

    Raises:
        AnalysisError: There is none.
        hexapod_doe.designs.plan_file.PlanError: A plan cannot be read.
    """
    plans = [*study.glob(f'*/{PLAN_FILE}'), *study.glob(f'*/{CONFIRM_FOLDER}/{PLAN_FILE}')]
    folders = sorted(
        (p.parent for p in plans), key=lambda f: (f.relative_to(study).parts[0] != MAIN, f)
    )
    if not folders:
        raise AnalysisError(
            f'{study}: no campaign, expected folders with a {PLAN_FILE}; '
            f'`ros2 run hexapod_doe plan --out {study}/{MAIN}/{PLAN_FILE}` begins one'
        )
    return [Part.read(each) for each in folders]


def estimate(parts: Sequence[Part], workers: int) -> str:
    """Return how many runs are left of each campaign, and about how many hours they take."""
    lines, total = [], 0.0
    for part in parts:
        hours = part.left * part.seconds_per_run / _HOUR_S / max(1, min(workers, part.left))
        total += hours
        basis = 'as its own runs took' if part.measured else 'judged by a shared core'
        text = f'about {hours:.1f} h, {basis}' if part.left else 'done'
        lines.append(f'{part.folder}: {part.left} of {len(part.progress.runs)} runs left, {text}')
    return '\n'.join([*lines, f'about {total:.1f} h in all with {workers} workers'])


def plan_confirmation(campaign: Path) -> None:
    """Plan the confirmation of a finished campaign, unless it is planned or unfinished.

    The three best sets, those that are always confirmed, and the cheapest one that is not worse.

    Raises:
        AnalysisError: The campaign cannot be analysed.
        BagError: A bag cannot be read.
    """
    out = campaign / CONFIRM_FOLDER / PLAN_FILE
    if out.is_file() or Part.read(campaign).left:
        return
    found = analyse(read_bags([campaign])[:1], Options(confirmation=plan_rule([campaign])))
    best = [check.label for check in found.confirmation.checks] if found.confirmation else []
    cheapest = [found.purchase.cheapest] if found.purchase else []
    sets = dict.fromkeys((*best, *ALWAYS_CONFIRMED, *cheapest))
    plan_command.main(
        ['confirm', str(campaign), '--sets', ','.join(sets), '--replicates', str(CONFIRMING_RUNS)]
    )


def launch(part: Part, workers: int) -> bool:
    """Train what is left of a campaign on live workers; return whether all of it is done then."""
    plan = part.folder / PLAN_FILE
    subprocess.run(
        [
            'ros2', 'launch', 'hexapod_bringup', 'campaign.launch.xml', f'plan:={plan}',
            'record_every:=0', f'local_workers:={workers}',
        ],
        check=False,
    )  # fmt: skip
    return Part.read(part.folder).left == 0


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 if the study is done, 1 if some runs are not, 2 after an error, 130 if stopped."""
    args = _parser().parse_args(arguments)
    workers = args.workers or usable_cores()
    try:
        print(estimate(parts_of(args.study), workers), flush=True)
        return 0 if args.estimate else _run(args.study, workers)
    except (AnalysisError, BagError, TableError, ValueError, OSError) as error:
        print(f'run_study: {one_line(error)}', file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print('run_study: interrupted; the same command goes on', file=sys.stderr)
        return 130


def _run(study: Path, workers: int) -> int:
    """Train one campaign after the other; what one leaves undone keeps none from its turn."""
    tried: set[Path] = set()
    while part := next((p for p in parts_of(study) if p.left and p.folder not in tried), None):
        tried.add(part.folder)
        if not launch(part, workers):
            print(f'run_study: {part.folder} is not finished', file=sys.stderr)
        if (study / MAIN / PLAN_FILE).is_file():
            plan_confirmation(study / MAIN)
    return 1 if any(part.left for part in parts_of(study)) else 0


def _parser() -> CommandLine:
    parser = CommandLine(prog='run_study', description=__doc__)
    parser.add_argument('study', type=folder, help='folder above those of the campaigns')
    parser.add_argument('--workers', type=whole(ge=1), help='side by side; default one per core')
    parser.add_argument('--estimate', action='store_true', help='say how long, and train nothing')
    return parser


if __name__ == '__main__':
    sys.exit(main())
