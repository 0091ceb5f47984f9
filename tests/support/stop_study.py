# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Study of the stop rule on simulated campaigns: what does it lose, and how many runs save?

    python tests/support/stop_study.py --repeats 200

prints the table of docs/statistics.md. Half of the campaigns have failures in 20 % of their runs,
half in 2 %. Each is a quarter fraction whose replicates complete together, up to ten; its effects
are drawn: seven of sensors, three of interactions, failures that depend on two sensors.
"""

import numpy as np
import pandas as pd
from hexapod_doe.campaigns.stop_rule import LEAST_ROUNDS
from hexapod_doe.choosing.choice import decide, expected_loss
from hexapod_doe.designs.design import fraction
from hexapod_doe.designs.terms import terms_up_to
from hexapod_doe.fitting.model import corners
from hexapod_doe.records.options import Options
from hexapod_sim.command_line import CommandLine, whole
from simulated import Truth, repeated_levels, table_of

DELTAS = (5.0, 10.0, 20.0, 30.0)
MOST = 10
"""Replicates of a whole campaign."""
_FAILING = {0.2: -1.53, 0.02: -4.1}
"""Constant of the log-odds, by the share that fails."""
_MAINS, _PAIRS = 25.0, 12.0
"""Deviations of the coefficients."""


def drawn_truth(share: float, rng: np.random.Generator) -> Truth:
    """Return a truth with effects of its own."""
    factors = fraction('quarter').factors
    pairs = rng.choice([term for term in terms_up_to(factors, 2) if len(term) == 2], 3, False)
    success = {'1': 420.0, **dict(zip(factors, rng.normal(0, _MAINS, len(factors)), strict=True))}
    success |= {str(pair): float(rng.normal(0, _PAIRS)) for pair in pairs}
    return Truth(success=success, failure={'1': _FAILING[share], 'B': -0.45, 'C': -0.55})


def path_of(truth: Truth, rng: np.random.Generator, least_delta: float) -> pd.DataFrame:
    """Return expected and true loss after each replicate, as far as any rule goes."""
    design = fraction('quarter')
    mean = truth.mean(corners(list(design.factors)))
    response = truth.simulate(repeated_levels(design, MOST), rng).reshape(design.cases, MOST)
    rows = []
    for replicates in range(LEAST_ROUNDS, MOST + 1):
        levels = repeated_levels(design, replicates)
        outlook = decide(table_of(levels, response[:, :replicates].ravel()), Options())
        chosen = outlook.labels.index(outlook.ranking[0])
        expected = expected_loss(outlook, seed=1)
        rows.append((replicates, expected, mean.max() - mean[chosen]))
        if expected is not None and expected < least_delta:
            break
    return pd.DataFrame(rows, columns=['replicates', 'expected', 'true'])


def study(repeats: int, seed: int) -> pd.DataFrame:
    """Return the paths of some campaigns of each kind, with `share` that fails and `campaign`."""
    paths = []
    for share in _FAILING:
        for number in range(repeats // len(_FAILING)):
            rng = np.random.default_rng([seed, int(100 * share), number])
            path = path_of(drawn_truth(share, rng), rng, min(DELTAS))
            paths.append(path.assign(share=share, campaign=number))
    return pd.concat(paths, ignore_index=True)


def stopped(paths: pd.DataFrame, delta: float) -> pd.DataFrame:
    """Return the row of each campaign at which the rule ends it."""
    keys = ['share', 'campaign']
    last = paths.groupby(keys).tail(1)
    below = paths[paths['expected'] < delta].groupby(keys).head(1)
    both = pd.concat([below.assign(by_rule=True), last.assign(by_rule=False)])
    return both.drop_duplicates(keys).sort_values(keys, ignore_index=True)


def table(paths: pd.DataFrame) -> pd.DataFrame:
    """Return, by share of failures and δ, what the rule loses and saves."""
    rows = []
    for share in _FAILING:
        for delta in DELTAS:
            ends = stopped(paths[paths['share'] == share], delta)
            early = ends[ends['by_rule']]
            rows.append(
                {
                    'failing': share,
                    'delta': delta,
                    'stopped': len(early) / len(ends),
                    'expected': early['expected'].mean(),
                    'true': early['true'].mean(),
                    'error': early['true'].std() / np.sqrt(max(1, len(early))),
                    'runs_saved': 1 - ends['replicates'].mean() / MOST,
                }
            )
    return pd.DataFrame(rows)


def main() -> None:
    """Run the study and print its table."""
    parser = CommandLine(prog='stop_study', description=__doc__)
    parser.add_argument('--repeats', type=whole(ge=2), default=200, help='campaigns (default 200)')
    parser.add_argument('--seed', type=whole(ge=0), default=1)
    args = parser.parse_args()
    found = table(study(args.repeats, args.seed))
    print(found.to_string(index=False, float_format='{:.3f}'.format))


if __name__ == '__main__':
    main()
