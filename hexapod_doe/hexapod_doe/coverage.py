# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Study of the analysis on simulated campaigns: do its intervals cover, are its choices good?

    python -m hexapod_doe.coverage --repeats 200

prints the tables of docs/statistics.md.
"""

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import pandas as pd

from hexapod_doe.analysis import analyse
from hexapod_doe.design import Design, fraction
from hexapod_doe.findings import Bounds, Estimate
from hexapod_doe.model import corners, labels
from hexapod_doe.options import Options
from hexapod_doe.prediction import rank_descending
from hexapod_doe.results import Analysis
from hexapod_doe.simulated import Truth, repeated_levels, table_of

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

    def __init__(self, truth: Truth, design: Design, replicates: int) -> None:
        """Compute every target of the truth."""
        self.truth = truth
        self.replicates = replicates
        self.levels = repeated_levels(design, replicates)
        self.grid = corners(design.factors)
        self.labels = labels(self.grid)
        self.mean = truth.mean(self.grid)
        self.targets = {
            'mean': self.mean,
            'iqm': truth.iqm(self.grid),
            'best_of:3': truth.best_of(self.grid, 3),
        }
        self.trimmed = truth.mean_of_best(self.grid, replicates - 3, replicates)

    def run(self, repeats: int, seed: int) -> Tally:
        """Simulate and judge some campaigns."""
        tally = Tally()
        for stream in np.random.SeedSequence(seed).spawn(repeats):
            rng = np.random.default_rng(stream)
            table = table_of(self.levels, self.truth.simulate(self.levels, rng))
            whole = analyse([table], Options())
            self._judge(tally, whole, rng)
            self._compare(tally, whole, analyse([table], Options(article=True)), rng)
        return tally

    def _judge(self, tally: Tally, analysis: Analysis, rng: np.random.Generator) -> None:
        """Judge the intervals and probabilities that the analysis states."""

        def cover(name: str, estimates: Mapping[str, Estimate], target: np.ndarray) -> None:
            bounds = [estimates[label].ci for label in self.labels]
            tally.cover(STATED, name, analysis.level, bounds, target)

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
            new_run = self.truth.simulate(self.grid, rng)
            tally.cover(STATED, 'one new run, two-part', analysis.level, bounds, new_run)
            self._choose(tally, 'two-part', parts.choice)
        self._judge_ranks(tally, analysis)
        self._judge_confirmation(tally, analysis, rng)
        self._judge_purchase(tally, analysis)

    def _judge_ranks(self, tally: Tally, analysis: Analysis) -> None:
        ranks = analysis.rank_uncertainty
        if ranks is None:
            return
        bounds = [ranks.rank_interval[label] for label in self.labels]
        tally.cover(STATED, 'rank', analysis.level, bounds, rank_descending(self.mean))
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
        runs = [self.truth.simulate(self.grid.iloc[index], rng) for _ in range(rule.runs)]
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

    def _compare(
        self, tally: Tally, whole: Analysis, article: Analysis, rng: np.random.Generator
    ) -> None:
        """Judge the classical intervals, which hold for the selected model and normal errors."""
        level = whole.level
        ci = [item.ci for item in whole.predictions]
        tally.cover(COMPARED, 'mean, final model after elimination', level, ci, self.mean)
        pi = [item.pi for item in whole.predictions]
        new_run = self.truth.simulate(self.grid, rng)
        tally.cover(COMPARED, 'one new run, final model', level, pi, new_run)
        ci = [item.ci for item in article.predictions]
        tally.cover(COMPARED, "article's CI, for the mean of all runs", level, ci, self.mean)
        best = f'best {self.replicates - 3} of {self.replicates}'
        name = f"article's CI, for the mean of the {best}"
        tally.cover(COMPARED, name, level, ci, self.trimmed)
        self._choose(tally, 'final model, all runs', whole.ranking[0])
        self._choose(tally, "article's, worst three dropped", article.ranking[0])

    def _choose(self, tally: Tally, rule: str, label: str) -> None:
        value = self.mean[self.labels.index(label)]
        outcome = (float(self.mean.max() - value), float(value == self.mean.max()))
        tally.choices.setdefault(rule, []).append(outcome)


def main() -> None:
    """Run the study and print its tables."""
    parser = argparse.ArgumentParser(prog='coverage', description=__doc__)
    parser.add_argument('--repeats', type=int, default=200, help='campaigns (default 200)')
    parser.add_argument('--seed', type=int, default=1)
    args = parser.parse_args()
    tally = Study(Truth(), fraction('quarter'), 10).run(args.repeats, args.seed)
    for frame in (tally.coverage_table(), tally.choice_table(), tally.claim_table()):
        print(frame.to_string(index=False, float_format='{:.3f}'.format))
        print()


if __name__ == '__main__':
    main()
