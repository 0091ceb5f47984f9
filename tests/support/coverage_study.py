# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Study of the analysis on simulated campaigns: do its intervals cover, are its choices good?

    python tests/support/coverage_study.py failures --repeats 200

prints the tables of docs/statistics.md; `scenarios` names the kinds of campaigns.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import pandas as pd
from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.choosing.attribution import alias_safe
from hexapod_doe.choosing.prediction import rank_descending
from hexapod_doe.fitting.model import corners, estimable_terms, labels
from hexapod_doe.records.findings import Bounds, Estimate
from hexapod_doe.records.options import Options
from hexapod_doe.records.results import Analysis
from hexapod_sim.command_line import CommandLine, number, whole
from scenarios import SCENARIOS, Scenario
from simulated import table_of

STATED = 'stated'
COMPARED = 'for comparison'


@dataclass
class Tally:
    """Shares of covered targets and outcomes of choices, one value per campaign."""

    coverage: dict[tuple[str, str, float], list[float]] = field(default_factory=dict)
    """By kind, interval and nominal confidence."""
    choices: dict[str, list[tuple[float, float]]] = field(default_factory=dict)
    """Regret and whether it is the best set, by rule."""
    claims: dict[str, list[tuple[float, float]]] = field(default_factory=dict)
    """Probability claimed and whether it came true, by claim."""

    def cover(
        self, kind: str, name: str, level: float, bounds: Sequence[Bounds], target: np.ndarray
    ) -> None:
        """Add the share of targets that lie within their bounds; missing bounds don't count."""
        hits = [
            low <= value <= high
            for (low, high), value in zip(bounds, target, strict=True)
            if low is not None and high is not None
        ]
        self.coverage.setdefault((kind, name, level), []).append(float(np.mean(hits)))

    def coverage_table(self) -> pd.DataFrame:
        """Return mean coverage and its Monte Carlo error by interval."""
        rows = [
            (kind, name, level, np.mean(shares), np.std(shares) / np.sqrt(len(shares)))
            for (kind, name, level), shares in self.coverage.items()
        ]
        return pd.DataFrame(rows, columns=['kind', 'interval', 'nominal', 'coverage', 'error'])

    def choice_table(self) -> pd.DataFrame:
        """Return mean regret and the share of best picks by rule."""
        rows = [
            (name, *np.mean(values, axis=0), np.std([v[0] for v in values]) / np.sqrt(len(values)))
            for name, values in self.choices.items()
        ]
        return pd.DataFrame(rows, columns=['rule', 'regret', 'best', 'regret error'])

    def claim_table(self) -> pd.DataFrame:
        """Return the mean probability claimed and how often the claim was true."""
        rows = [(name, *np.mean(values, axis=0)) for name, values in self.claims.items()]
        return pd.DataFrame(rows, columns=['claim', 'claimed', 'true'])


class Study:
    """Simulates campaigns of one truth and judges what the analysis says about them."""

    def __init__(self, scenario: Scenario, split: bool = False) -> None:
        """Compute every target of the truth.

        Args:
            scenario: How runs come about, and which there are.
            split: Judge apart the sets whose prediction no name of an effect changes.
        """
        self.truth = truth = scenario.truth
        self.levels, self.blocks = scenario.levels, scenario.blocks
        self.grid = corners([str(name) for name in scenario.levels.columns])
        runs = scenario.levels.groupby(list(scenario.levels.columns)).size()
        self.replicates = int(runs.iloc[0]) if runs.nunique() == 1 else None
        self.labels = labels(self.grid)
        self.mean = truth.mean(self.grid)
        self.targets = {
            'mean': self.mean,
            'iqm': truth.iqm(self.grid),
            'best_of:3': truth.best_of(self.grid, 3),
        }
        self.trimmed = None
        if scenario.article:
            assert self.replicates is not None
            kept = self.replicates - 3
            self.trimmed = truth.mean_of_best(self.grid, kept, self.replicates)
        safe = alias_safe(self.levels, estimable_terms(self.levels, 2))
        self.groups = (
            {', alias-safe sets': safe, ', other sets': ~safe}
            if split
            else {'': np.ones_like(safe)}
        )

    def run(self, repeats: int, seed: int) -> Tally:
        """Simulate and judge some campaigns."""
        tally = Tally()
        for stream in np.random.SeedSequence(seed).spawn(repeats):
            rng = np.random.default_rng(stream)
            response = self.truth.simulate(self.levels, rng)
            if self.blocks is not None:
                shared = rng.normal(0, self.truth.block_sigma, self.blocks.max() + 1)
                response = response + shared[self.blocks]
            table = table_of(self.levels, response, self.blocks)
            whole = analyse([table], Options())
            self._judge(tally, whole, rng)
            self._compare(tally, whole, rng)
            if self.trimmed is not None:
                self._compare_article(tally, analyse([table], Options(article=True)))
        return tally

    def _new_run(self, levels: pd.DataFrame, rng: np.random.Generator) -> np.ndarray:
        """Return one new run of each row, each of a block of its own (n,)."""
        shared = rng.normal(0, self.truth.block_sigma, len(levels))
        return self.truth.simulate(levels, rng) + shared

    def _judge(self, tally: Tally, analysis: Analysis, rng: np.random.Generator) -> None:
        """Judge the intervals and probabilities that the analysis states."""

        def cover(name: str, estimates: Mapping[str, Estimate], target: np.ndarray) -> None:
            bounds = [estimates[label].ci for label in self.labels]
            self._cover(tally, STATED, name, analysis.level, bounds, target)

        for result in analysis.estimands:
            cover(f'{result.name} of the runs', result.predictions, self.targets[result.name])
        if analysis.averaging is not None:
            cover('mean, averaged over models', analysis.averaging.predictions, self.mean)
            self._choose(tally, 'averaged over models', analysis.averaging.choice)
        parts = analysis.two_part
        if parts is not None:
            cover('probability of failure', parts.p_failure, self.truth.p_failure(self.grid))
            cover(
                'reward given success', parts.reward_success, self.truth.reward_success(self.grid)
            )
            cover('mean, two-part', parts.expected, self.mean)
            bounds = [parts.run_interval[label] for label in self.labels]
            new_run = self._new_run(self.grid, rng)
            self._cover(tally, STATED, 'one new run, two-part', analysis.level, bounds, new_run)
            self._choose(tally, 'two-part', parts.choice)
        self._judge_ranks(tally, analysis)
        self._judge_confirmation(tally, analysis, rng)
        self._judge_purchase(tally, analysis)

    def _judge_ranks(self, tally: Tally, analysis: Analysis) -> None:
        ranks = analysis.rank_uncertainty
        if ranks is None:
            return
        bounds = [ranks.rank_interval[label] for label in self.labels]
        self._cover(tally, STATED, 'rank', analysis.level, bounds, rank_descending(self.mean))
        best = self.labels[int(self.mean.argmax())]
        tally.claims.setdefault('the choice is the best set', []).append(
            (ranks.p_best[analysis.choice], float(analysis.choice == best))
        )

    def _judge_confirmation(
        self, tally: Tally, analysis: Analysis, rng: np.random.Generator
    ) -> None:
        rule = analysis.confirmation
        if rule is None:
            return
        index = [self.labels.index(check.label) for check in rule.checks]
        runs = [self._new_run(self.grid.iloc[index], rng) for _ in range(rule.runs)]
        bounds = [check.interval for check in rule.checks]
        name = f'mean of {rule.runs} confirmation runs'
        tally.cover(STATED, name, rule.level, bounds, np.mean(runs, axis=0))

    def _judge_purchase(self, tally: Tally, analysis: Analysis) -> None:
        purchase = analysis.purchase
        if purchase is None:
            return
        mean = dict(zip(self.labels, self.mean, strict=True))
        bounds = [item.loss_ci for item in purchase.breakage]
        losses = [mean[item.label] - mean[item.remaining] for item in purchase.breakage]
        tally.cover(STATED, 'loss of a device', analysis.level, bounds, np.array(losses))
        claimed = {item.label: item.p_not_worse for item in purchase.sets}[purchase.cheapest]
        kept = mean[purchase.cheapest] >= self.mean.max() - purchase.delta
        tally.claims.setdefault('the cheapest set is not worse than delta', []).append(
            (claimed, float(kept))
        )

    def _compare(self, tally: Tally, whole: Analysis, rng: np.random.Generator) -> None:
        """Judge the classical intervals, which hold for the selected model and normal errors."""
        ci, pi = zip(*((item.ci, item.pi) for item in whole.predictions), strict=True)
        for name, bounds, target in (
            ('mean, final model after elimination', ci, self.mean),
            ('one new run, final model', pi, self._new_run(self.grid, rng)),
        ):
            self._cover(tally, COMPARED, name, whole.level, bounds, target)
        self._choose(tally, 'final model, all runs', whole.ranking[0])

    def _compare_article(self, tally: Tally, article: Analysis) -> None:
        """Judge the article's procedure, which drops the worst three runs of each case."""
        assert self.replicates is not None  # the caller has looked
        assert self.trimmed is not None
        classical = [item.ci for item in article.predictions]
        best = f'best {self.replicates - 3} of {self.replicates}'
        for name, target in (
            ("article's CI, for the mean of all runs", self.mean),
            (f"article's CI, for the mean of the {best}", self.trimmed),
        ):
            self._cover(tally, COMPARED, name, article.level, classical, target)
        self._choose(tally, "article's, worst three dropped", article.ranking[0])

    def _cover(
        self,
        tally: Tally,
        kind: str,
        name: str,
        level: float,
        bounds: Sequence[Bounds],
        target: np.ndarray,
    ) -> None:
        """Tally the intervals of all combinations, by group."""
        for suffix, inside in self.groups.items():
            chosen = np.flatnonzero(inside)
            tally.cover(
                kind, name + suffix, level, [bounds[int(i)] for i in chosen], target[chosen]
            )

    def _choose(self, tally: Tally, rule: str, label: str) -> None:
        value = self.mean[self.labels.index(label)]
        outcome = (float(self.mean.max() - value), float(value == self.mean.max()))
        tally.choices.setdefault(rule, []).append(outcome)


def main() -> None:
    """Run the study and print its tables."""
    parser = CommandLine(prog='coverage', description=__doc__)
    parser.add_argument('scenario', choices=list(SCENARIOS), help='kind of campaigns')
    parser.add_argument('--repeats', type=whole(ge=1), default=200, help='campaigns (default 200)')
    parser.add_argument('--seed', type=whole(ge=0), default=1)
    parser.add_argument(
        '--aliased', type=number(), metavar='FG', help='add an effect FG, confounded with CE, and '
        'judge apart the sets that it cannot mislead',
    )  # fmt: skip
    args = parser.parse_args()
    scenario = SCENARIOS[args.scenario]()
    if args.aliased is not None:
        success = {**scenario.truth.success, 'FG': args.aliased}
        scenario = replace(scenario, truth=replace(scenario.truth, success=success))
    tally = Study(scenario, split=args.aliased is not None).run(args.repeats, args.seed)
    for frame in (tally.coverage_table(), tally.choice_table(), tally.claim_table()):
        print(frame.to_string(index=False, float_format='{:.3f}'.format))
        print()


if __name__ == '__main__':
    main()
