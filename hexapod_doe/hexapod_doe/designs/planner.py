# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""From hours to a plan: which design, replicates and episodes a budget pays for."""

from dataclasses import dataclass

from hexapod_doe.designs.aliases import aberration_note, alias_sets, clear_interactions, resolution
from hexapod_doe.designs.catalogue import catalogue_generators, fractions_of
from hexapod_doe.designs.design import FRACTIONS, Design, factor_letters
from hexapod_doe.designs.power import replicates_for, smallest_effect

FULL_TRAINING = 1000
"""Episodes of a whole training run in the article."""
TARGET = 0.32
"""The effect that the article's 32 cases x 10 replicates find, in standard deviations of a run."""
_ERROR_DF = 5
"""With fewer degrees of freedom than this an error is too rough to test against."""
_SHARP = 1.0
"""An effect of one standard deviation of a run: what a plan should be able to see."""


@dataclass(frozen=True)
class Budget:
    """Machine time, and what an episode was measured to cost."""

    hours: float
    """Wall time that is to be used, h."""
    seconds_per_episode: float
    """Measured wall time of one episode on one worker, s."""
    workers: int = 1
    """Workers that run side by side at that speed."""

    def __post_init__(self) -> None:
        for name in ('hours', 'seconds_per_episode', 'workers'):
            if not getattr(self, name) > 0:
                raise ValueError(f'{name} {getattr(self, name)}: expected a positive number')

    @property
    def episodes(self) -> int:
        """The episodes that fit into the budget, over all workers."""
        return int(self.hours * 3600 * self.workers / self.seconds_per_episode)

    def hours_for(self, episodes: int) -> float:
        """Return the wall time of a number of episodes, h."""
        return episodes * self.seconds_per_episode / 3600 / self.workers


@dataclass(frozen=True)
class Option:
    """One way to spend the budget."""

    design: Design
    replicates: int
    episodes: int
    """Episodes of each training run."""
    hours: float
    """Wall time, h."""

    @property
    def runs(self) -> int:
        """Training runs in all."""
        return self.design.cases * self.replicates

    @property
    def separable(self) -> int:
        """How many main effects and two-factor interactions have a column of their own."""
        return len(self.design.factors) + len(
            clear_interactions(self.design.levels, self.design.factors)
        )

    @property
    def parameters(self) -> int:
        """Terms of the model that the error allows: to order 2, or else main effects alone."""
        full = 1 + len(alias_sets(self.design.levels, self.design.factors, 2))
        return full if self.runs >= full + _ERROR_DF else 1 + len(self.design.factors)

    @property
    def sees(self) -> float:
        """The smallest effect found with 80 % power at 5 %, in standard deviations of a run."""
        if self.runs <= self.parameters:
            return float('inf')
        return smallest_effect(self.runs, self.parameters)


def options(
    budget: Budget, factors: int = 7, episodes: int = FULL_TRAINING, target: float = TARGET
) -> list[Option]:
    """Return, for each design of resolution IV or more, the replicates that are affordable.

    No more than see the target effect. A design whose single replicate is beyond the budget is
    offered with shorter trainings.

    Args:
        budget: The machine time.
        factors: How many factors are in question.
        episodes: The wanted length of each training run.
        target: The effect that is small enough, in standard deviations of a run.

    Raises:
        ValueError: Not even one episode per case of the smallest design is affordable.
    """
    found = []
    for design in _designs(factors):
        terms = 1 + len(alias_sets(design.levels, design.factors, 2))
        enough = replicates_for(target, design.cases, terms)
        affordable = max(1, budget.episodes // (design.cases * episodes))
        replicates = min(enough, affordable)
        length = min(episodes, budget.episodes // (design.cases * replicates))
        if length >= 1:
            used = budget.hours_for(design.cases * replicates * length)
            found.append(Option(design, replicates, length, used))
    if not found:
        least = budget.hours_for(min(design.cases for design in _designs(factors)))
        raise ValueError(
            f'{budget.hours:g} h pay for {budget.episodes} episodes: not one per case; expected '
            f'at least {least:.2g} h'
        )
    return found


def propose(found: list[Option]) -> Option:
    """Choose among options: whole trainings first, then replicates, then fewer aliases.

    Of the options with whole trainings and two or more replicates, the one that separates most
    terms while it still sees an effect of one standard deviation; if none sees that, the one that
    sees most. Without such an option the smallest design, whose trainings are the longest.
    """
    longest = max(option.episodes for option in found)
    whole = [option for option in found if option.episodes == longest]
    replicated = [option for option in whole if option.replicates > 1]
    sharp = [option for option in replicated if option.sees <= _SHARP]
    if sharp:
        return max(sharp, key=lambda option: (option.separable, option.replicates))
    return min(replicated or whole, key=lambda option: (option.sees, option.runs))


def describe(option: Option, wanted: int = FULL_TRAINING, sigma: float | None = None) -> str:
    """Return in words what an option is and what it will be able to see.

    Args:
        option: The proposal.
        wanted: The length of training that was asked for, episodes.
        sigma: Standard deviation of one run's response if it is known, in reward units.
    """
    size = f'{option.sees:.2f} standard deviations of one run'
    if sigma is not None:
        size = f'{option.sees * sigma:.3g} reward units ({size})'
    lines = [
        f'{option.design.name}: {option.design.cases} cases x {option.replicates} replicates x '
        f'{option.episodes} episodes = {option.hours:.1f} h',
        f'Finds effects of {size} with 80 % power at the 5 % level, in a model of '
        f'{option.parameters} terms.',
    ]
    mixed = [
        group.text
        for group in alias_sets(option.design.levels, option.design.factors, 2)
        if len(group.terms) > 1
    ]
    if mixed:
        lines.append(f'Cannot separate: {"; ".join(mixed)}.')
    if note := aberration_note(option.design):
        lines.append(note)
    if option.replicates == 1:
        lines.append('One replicate: the spread between runs of one case stays unknown.')
    if option.episodes < wanted:
        lines.append(
            f'{option.episodes} of {wanted} episodes: agents will be judged before they have '
            'learned; a tour, not a conclusion.'
        )
    return '\n'.join(lines)


def _designs(count: int) -> list[Design]:
    letters = factor_letters(count)
    names = {p: name for name, p in FRACTIONS.items()}
    designs = [
        Design(names.get(p, f'2^({count}-{p})'), letters, catalogue_generators(letters, p))
        for p in fractions_of(count)
    ]
    good = [d for d in designs if (resolution(d.words) or count + 1) >= 4]
    return good or designs
