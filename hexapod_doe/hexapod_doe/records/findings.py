# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Records of what an analysis adds to the fitted model: the parts that the article did not ask.

Every number in a map belongs to the combination whose label is the key, in original units.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from hexapod_doe.fitting.dispersion import Dispersion

Bounds = tuple[float | None, float | None]


@dataclass(frozen=True)
class Estimate:
    """One number of one combination with its interval."""

    fit: float
    ci: Bounds


@dataclass(frozen=True)
class EstimandResult:
    """All combinations under one declared summary of a case's runs."""

    name: str
    """`mean`, `iqm`, `best_of:3`, …"""
    description: str
    terms: tuple[str, ...]
    coef: Mapping[str, float]
    predictions: Mapping[str, Estimate]
    ranking: tuple[str, ...]
    choice: str


@dataclass(frozen=True)
class TwoPart:
    """Probability of a failed training, and reward given success."""

    threshold: float
    """Runs below it count as failed."""
    threshold_rule: str
    runs: int
    failures: int
    failures_by_case: Mapping[str, int]
    cases_without_success: tuple[str, ...]
    failure_terms: tuple[str, ...]
    failure_coef: Mapping[str, float]
    """Log-odds of failure per coded unit."""
    failure_se: Mapping[str, float]
    failure_lack_of_fit: float | None
    """p that the model of failures fits the share of each case; None without spare cases."""
    success_terms: tuple[str, ...]
    success_coef: Mapping[str, float]
    dispersion: Dispersion | None
    """Whether the spread of the successes differs by factor; None with too few to tell."""
    mean_failed: float
    p_failure: Mapping[str, Estimate]
    reward_success: Mapping[str, Estimate]
    expected: Mapping[str, Estimate]
    """(1−π)·reward given success + π·mean of the failed."""
    run_interval: Mapping[str, Bounds]
    """Prediction interval of one new run, failures included."""
    selected_failure_terms: tuple[str, ...]
    selected_success_terms: tuple[str, ...]
    """Terms left after elimination: these models choose, the ones above state."""
    selected: Mapping[str, float]
    """Expected reward by the models after elimination."""
    ranking: tuple[str, ...]
    """By the models after elimination."""
    choice: str


@dataclass(frozen=True)
class RankUncertainty:
    """How sure the order of the combinations is, by draws from the fitted model."""

    draws: int
    p_best: Mapping[str, float]
    """Combinations of equal value share their chance, so that all sum to 1."""
    p_top3: Mapping[str, float]
    rank_interval: Mapping[str, tuple[int, int]]
    """Ranks that hold with the analysis' confidence."""
    groups: tuple[tuple[str, ...], ...]
    """Combinations, best first, that can't be told from the first one of their group."""


@dataclass(frozen=True)
class Attribution:
    """What depends on the name that is given to a confounded pair."""

    ambiguous: Mapping[str, tuple[str, ...]]
    """Each ambiguous term of the model and the terms it may stand for."""
    partial: Mapping[str, Mapping[str, float]]
    """Each term of the model that holds a part of others, with their weights in it."""
    attributions: int
    """Ways to name them all."""
    examined: int
    winners: Mapping[str, int]
    """Best combination under each naming and how many namings agree."""
    rank_range: Mapping[str, tuple[int, int]]
    fit_range: Mapping[str, tuple[float, float]]
    safe: tuple[str, ...]
    """Combinations whose prediction is the same under every naming."""


@dataclass(frozen=True)
class Averaging:
    """Predictions averaged over models, by exp(−BIC/2) and a prior that favours heredity."""

    models: int
    weights: tuple[tuple[tuple[str, ...], float], ...]
    """The heaviest models: terms and weight."""
    p_active: Mapping[str, float]
    """Weight of the models that hold each term."""
    predictions: Mapping[str, Estimate]
    ranking: tuple[str, ...]
    choice: str


@dataclass(frozen=True)
class ConfirmationCheck:
    """One combination's confirmation runs against the interval stated before them."""

    label: str
    predicted: float
    interval: Bounds
    """Prediction interval of the mean of `runs` new runs."""
    runs: int
    observed: tuple[float, ...]
    observed_mean: float | None
    """None while there are no runs yet."""
    passed: bool | None


@dataclass(frozen=True)
class Confirmation:
    """The validation rule and its outcome."""

    level: float
    runs: int
    """Confirmation runs of each set that the rule asks for."""
    rule: str
    checks: tuple[ConfirmationCheck, ...]
    """The choice and the two next best, then any other set that was run."""


@dataclass(frozen=True)
class Device:
    """One purchasable device and the observations that it yields."""

    name: str
    yields: str
    cost: float
    mass: float
    power: float
    failure_probability: float


@dataclass(frozen=True)
class PricedSet:
    """One combination with the devices it needs and what they take."""

    label: str
    devices: tuple[str, ...]
    cost: float
    mass: float
    power: float
    failure_probability: float
    """Probability that at least one of its devices breaks."""
    fit: float
    ci: Bounds
    p_front: float
    """Share of draws in which no cheaper-or-equal set has a higher reward."""
    on_front: bool
    p_not_worse: float
    """Probability that it is at most delta below the best."""


@dataclass(frozen=True)
class Breakage:
    """What is lost when one device of a set breaks and the robot is trained without it."""

    label: str
    device: str
    lost: str
    remaining: str
    fit: float
    loss: float
    loss_ci: Bounds


@dataclass(frozen=True)
class Purchase:
    """From statistics to a shopping list."""

    devices: tuple[Device, ...]
    currency: str
    delta: float
    confidence: float
    sets: tuple[PricedSet, ...]
    """All combinations in Yates order."""
    front: tuple[str, ...]
    """Pareto front of the fitted reward against cost, cheapest first."""
    cheapest: str
    """Cheapest set that is not worse than the best by more than delta, with that confidence."""
    cheapest_rule: str
    breakage: tuple[Breakage, ...]
    """For each device of the chosen and of the cheapest set."""
