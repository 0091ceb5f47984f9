# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How many runs would have been enough? Smaller campaigns drawn from the runs of a whole one.

    python -m hexapod_doe.studies.backtest bags/study/main --out backtest

draws some of the runs of each case, lets each procedure choose, and judges its choice by the
analysis of all runs. It leaves backtest.csv, backtest.png and a rule of thumb.
"""

import sys
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from hexapod_sim.command_line import CommandLine, folder, one_line, path, whole
from matplotlib.figure import Figure

from hexapod_doe.choosing.choice import decide
from hexapod_doe.choosing.devices import read_devices
from hexapod_doe.choosing.outlook import Outlook
from hexapod_doe.choosing.ranks import groups
from hexapod_doe.errors import AnalysisError, BagError, TableError
from hexapod_doe.records.options import Options
from hexapod_doe.reporting.figures.chart import Chart
from hexapod_doe.reporting.figures.style import INK, MARKERS, SERIES, WIDE
from hexapod_doe.reporting.formats import number, percent
from hexapod_doe.studies.winners import Winners
from hexapod_doe.tables.bag_table import read_bags
from hexapod_doe.tables.fractions import runs_of
from hexapod_doe.tables.table import RunTable

REPLICATES = (1, 2, 3, 5, 7)
DESIGNS = ('quarter', 'eighth')
PROCEDURES = ('two-part', 'article')
NAME = 'backtest'
_DRAWS, _SEED = 200, 1
_MEASURES = {
    'same_winner': 'share with the same winner',
    'in_top_group': 'share in the top group',
    'regret': 'mean reward lost',
}


@dataclass(frozen=True)
class Whole:
    """What all runs say: the values that smaller campaigns are judged by."""

    runs: int
    fits: np.ndarray
    """Values of the combinations (2^k,)."""
    winner: int
    top: frozenset[int]
    """The combinations that cannot be told from the winner."""
    tolerance: float
    """Reward that may be lost for little: the device table's share of the best."""

    @classmethod
    def of(cls, table: RunTable) -> 'Whole':
        """Analyse all runs, as `analyze` does."""
        outlook = decide(table, Options())
        return cls(
            runs=len(table.rows),
            fits=outlook.fits,
            winner=outlook.labels.index(outlook.ranking[0]),
            top=_top_group(outlook),
            tolerance=read_devices(None).delta_share * abs(float(np.nanmax(outlook.fits))),
        )


def _top_group(outlook: Outlook) -> frozenset[int]:
    if outlook.draws is None:
        return frozenset({outlook.labels.index(outlook.ranking[0])})
    first = groups(outlook.draws, outlook.fits, outlook.labels, Options().level)[0]
    return frozenset(map(outlook.labels.index, first))


def backtest(
    table: RunTable, whole: Whole, draws: int = _DRAWS, seed: int = _SEED
) -> pd.DataFrame:
    """Return a row for each design, procedure and number of replicates.

    Columns: design, procedure, replicates, runs, draws, same_winner, in_top_group (shares),
    regret and its standard error, and regret_share, of the best value. Numbers of replicates
    that a case has not are left out, and so are designs that the table has no case of.

    Args:
        table: The runs of the whole campaign.
        whole: What they say.
        draws: Smaller campaigns of each kind; those of fewer runs are parts of those of more.
        seed: Of the draws.

    Raises:
        TableError: The table has no case of any of the designs.
    """
    rows = []
    for design in DESIGNS:
        try:
            part = runs_of(table, design)
        except TableError:
            continue
        cases, values = _drawn(part, draws, seed)
        winners = Winners(cases)
        for replicates in (r for r in REPLICATES if r < values.shape[2]):
            some = values[:, :, :replicates]
            for procedure in PROCEDURES:
                chosen = (winners.two_part if procedure == 'two-part' else winners.article)(some)
                rows.append(
                    {
                        'design': design,
                        'procedure': procedure,
                        'replicates': replicates,
                        'runs': replicates * len(cases),
                        'draws': draws,
                        **_judged(whole, chosen),
                    }
                )
    if not rows:
        raise TableError(
            f'{table.title}: no design of {" or ".join(DESIGNS)} with two runs of each case, '
            'expected the runs of one at least'
        )
    return pd.DataFrame(rows)


def _drawn(table: RunTable, draws: int, seed: int) -> tuple[pd.DataFrame, np.ndarray]:
    """Return the levels of the cases, and their runs in random orders (draws, cases, runs).

    A case keeps the order of a draw in every design: its stream is that of its levels.
    """
    fewest = int(table.rows.groupby('case').size().min())
    found, values = [], []
    for _, rows in table.rows.groupby('case'):
        levels = rows[list(table.factors)].iloc[0]
        key = int(((levels.to_numpy() > 0) * 2 ** np.arange(len(levels))).sum())
        rng = np.random.default_rng([seed, key])
        runs = np.tile(rows['response'].to_numpy(float), (draws, 1))
        values.append(rng.permuted(runs, axis=1)[:, :fewest])
        found.append(levels)
    return pd.DataFrame(found).reset_index(drop=True), np.stack(values, axis=1)


def _judged(whole: Whole, chosen: np.ndarray) -> dict[str, float]:
    lost = whole.fits[whole.winner] - whole.fits[chosen]
    return {
        'same_winner': float((chosen == whole.winner).mean()),
        'in_top_group': float(np.isin(chosen, list(whole.top)).mean()),
        'regret': float(lost.mean()),
        'regret_error': float(lost.std(ddof=1) / np.sqrt(len(lost))),
        'regret_share': float(lost.mean() / abs(whole.fits[whole.winner])),
    }


def rule_of_thumb(whole: Whole, found: pd.DataFrame) -> str:
    """Return in a sentence how many runs lose so little that more would not have paid."""
    enough = found[found['regret'] <= whole.tolerance].sort_values(['runs', 'regret'])
    bound = f'{number(whole.tolerance)} ({percent(read_devices(None).delta_share)} of the best)'
    if enough.empty:
        best = found.sort_values('regret').iloc[0]
        return (
            f'No smaller campaign would have been enough: the best, {_kind(best)}, loses '
            f'{number(best["regret"])} of reward on average, more than {bound}.'
        )
    first = enough.iloc[0]
    return (
        f'{int(first["runs"])} runs would have been enough of {whole.runs}: {_kind(first)}, '
        f'chooses on average a set that loses {number(first["regret"])} of reward '
        f'({percent(first["regret_share"], 1)}) by the model of all runs, no more than {bound}; '
        f'the same winner in {percent(first["same_winner"])} of the draws.'
    )


def _kind(row: 'pd.Series[float]') -> str:
    runs = f'{row["replicates"]:g} run{"" if row["replicates"] == 1 else "s"} of each case'
    return f'the {row["design"]} with {runs}, chosen by the {row["procedure"]} procedure'


def chart(found: pd.DataFrame, rule: str) -> Chart:
    """Return the figure: regret and shares against the number of runs, a line for each kind."""
    kinds = [(design, procedure) for design in DESIGNS for procedure in PROCEDURES]

    def draw() -> Figure:
        figure = Figure(figsize=(WIDE, 2.9), layout='constrained')
        panels = figure.subplots(1, len(_MEASURES), sharex=True)
        for axes, (measure, title) in zip(panels, _MEASURES.items(), strict=True):
            for index, (design, procedure) in enumerate(kinds):
                rows = found[(found['design'] == design) & (found['procedure'] == procedure)]
                axes.plot(
                    rows['runs'], rows[measure], color=SERIES[index], marker=MARKERS[index],
                    linestyle='-' if procedure == 'two-part' else '--',
                    label=f'{design}, {procedure}',
                )  # fmt: skip
            axes.set_title(title, loc='left', color=INK)
            axes.set_ylim(bottom=0, top=None if measure == 'regret' else 1.02)
        panels[-1].set_xlabel('runs')
        figure.legend(*panels[0].get_legend_handles_labels(), loc='outside lower center', ncols=2)
        return figure

    return Chart(
        NAME,
        'Smaller campaigns, drawn from the runs of the whole one',
        'Each point is the mean over campaigns that were drawn from the published runs without '
        'replacement, judged by the model of all of them, which the larger ones share runs with '
        f'and are flattered by. {rule}',
        found,
        draw,
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Write table, figure and rule; return 0, or 2 where there is nothing to draw from."""
    args = _parser().parse_args(arguments)
    try:
        table = read_bags([args.bags])[0]
        whole_campaign = Whole.of(table)
        found = backtest(table, whole_campaign, args.draws, args.seed)
        rule = rule_of_thumb(whole_campaign, found)
        args.out.mkdir(parents=True, exist_ok=True)
        chart(found, rule).save(args.out, args.out)
        (args.out / f'{NAME}.txt').write_text(f'{rule}\n', encoding='utf-8')
    except (AnalysisError, BagError, TableError, OSError) as error:
        print(f'backtest: {one_line(error)}', file=sys.stderr)
        return 2
    print(found.to_string(index=False, float_format='{:.3f}'.format))
    print(rule)
    return 0


def _parser() -> CommandLine:
    parser = CommandLine(prog='backtest', description=__doc__)
    parser.add_argument('bags', type=path, help='folder of the whole campaign')
    parser.add_argument('--out', type=folder, required=True, metavar='DIR', help='results')
    parser.add_argument(
        '--draws', type=whole(ge=2), default=_DRAWS, metavar='N',
        help=f'smaller campaigns of each kind (default {_DRAWS})',
    )  # fmt: skip
    parser.add_argument('--seed', type=whole(ge=0), default=_SEED, help='of the draws (default 1)')
    return parser


if __name__ == '__main__':
    sys.exit(main())
