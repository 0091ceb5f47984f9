# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line that makes a campaign's plan, extends it, and says what it is able to see."""

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_sim.command_line import one_line

from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.forecast import is_foretold, seconds_of
from hexapod_doe.campaigns.next_steps import CONFIRM_FOLDER, after_confirm
from hexapod_doe.campaigns.plan_guard import check_free
from hexapod_doe.campaigns.progress import Progress
from hexapod_doe.campaigns.stop_rule import LEAST_ROUNDS
from hexapod_doe.designs.aliases import (
    aberration_note,
    alias_sets,
    defining_relation,
    defining_words,
    representatives,
    resolution,
    word_length_pattern,
)
from hexapod_doe.designs.augment import aimed_model, d_optimal, foldover, semifold, variance_ratios
from hexapod_doe.designs.blocks import confounded_with_blocks
from hexapod_doe.designs.confirm_plan import confirmation_plan
from hexapod_doe.designs.design import Design, factor_letters, fraction, from_generators
from hexapod_doe.designs.factor import Treatments, default_factors
from hexapod_doe.designs.factor_file import read_factors
from hexapod_doe.designs.plan_arguments import parse
from hexapod_doe.designs.plan_file import read_plan, write_plan
from hexapod_doe.designs.plan_table import follow_up, make_plan
from hexapod_doe.designs.plan_types import Confirmation, Plan
from hexapod_doe.designs.planner import Budget, describe, options, propose
from hexapod_doe.designs.power import power, smallest_effect
from hexapod_doe.designs.power_simulation import RunModel, simulate_power
from hexapod_doe.designs.stopping import with_rule
from hexapod_doe.designs.terms import terms_up_to

_HOUR_S = 3600.0
_FACTOR_FILES = ('.yaml', '.yml')
_ROMAN = {2: 'II', 3: 'III', 4: 'IV', 5: 'V', 6: 'VI', 7: 'VII', 8: 'VIII', 9: 'IX'}


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; without a command's name it makes a plan."""
    args = parse(list(sys.argv[1:] if arguments is None else arguments))
    try:
        _RUN[args.command](args)
    except (ValueError, OSError) as error:
        print(f'plan: {one_line(error)}', file=sys.stderr)
        sys.exit(2)


def _make(args: argparse.Namespace) -> None:
    treatments = _treatments(args)
    design = _design(args, treatments.letters)
    blocks = args.blocks.split(',') if args.blocks else []
    plan = make_plan(
        design,
        args.replicates,
        args.seed,
        common_seeds=args.common_seeds,
        in_turns=args.in_turns,
        blocks=blocks,
        confirmation=Confirmation(args.confirm_runs, args.confirm_level),
        treatments=treatments,
    )
    if note := aberration_note(design):
        print(note)
    if blocks:
        hidden = confounded_with_blocks(design.levels, design.factors, blocks)
        print(f'Blocks hide: {"; ".join(hidden)}')
    _finish(plan, plan.levels, args.out)


def _fold(args: argparse.Namespace) -> None:
    plan = read_plan(args.plan)
    if args.keep:
        added = semifold(plan.levels, plan.factors, args.on, args.keep)
        how = f'semifold on {args.on}, cases with {args.keep}'
    else:
        added, how = foldover(plan.levels, plan.factors, args.on), f'foldover on {args.on}'
    _extend(plan, added, how, args)


def _augment(args: argparse.Namespace) -> None:
    plan = read_plan(args.plan)
    model = (
        aimed_model(plan.levels, plan.factors, args.separate.split(','))
        if args.separate
        else terms_up_to(plan.factors, 2)
    )
    added = d_optimal(plan.levels, plan.factors, args.extra, model, args.seed)
    ratios = variance_ratios(
        np.vstack([plan.levels, added]), plan.factors, model, len(plan.levels)
    )
    _extend(plan, added, f'{args.extra} D-optimal cases', args)
    for term, ratio in ratios.items():
        if ratio > 1 + 1e-6:
            print(f'{term}: variance {ratio:.2f} times that of a term clear in the first plan')


def _confirm(args: argparse.Namespace) -> None:
    path = args.campaign / PLAN_FILE if args.campaign.is_dir() else args.campaign
    plan, folder = read_plan(path), path.parent
    sets = args.sets.split(',') if args.sets else leading_sets(folder)
    further = confirmation_plan(plan, sets, args.replicates)
    out = args.out or folder / CONFIRM_FOLDER / PLAN_FILE
    check_free(further, out)
    write_plan(further, out)
    assert further.settings is not None  # made here, not read
    print(f'{len(further.rows)} runs: {", ".join(further.settings.confirms)} -> {out}')
    if not further.treatments.only_sensors:
        for levels in further.levels:
            print(f'{further.treatments.label(levels)}  {further.treatments.text(levels)}')
    print(further.settings.confirmation.rule)
    print('\n'.join(['Next:', *(f'  {line}' for line in after_confirm(folder, out))]))


def _extend(plan: Plan, added: np.ndarray, how: str, args: argparse.Namespace) -> None:
    replicates = args.replicates or int(plan.rows['replicate'].max())
    further = follow_up(plan, added, how, replicates, args.seed)
    _finish(further, np.vstack([plan.levels, added]), args.out)


def _aliases(args: argparse.Namespace) -> None:
    if args.plan:
        plans = [read_plan(path) for path in args.plan]
        levels, factors = np.vstack([plan.levels for plan in plans]), plans[0].factors
    else:
        design = _design(args, _treatments(args).letters)
        levels, factors = design.levels, design.factors
        if note := aberration_note(design):
            print(note)
    words = defining_words(levels, factors)
    print(f'{len(levels)} cases')
    if words:
        _print_words(defining_relation(words), resolution(words))
        pattern = word_length_pattern(words, factors)
        print(f'Words by length: {", ".join(f"{k} = {n}" for k, n in pattern.items())}')
    for group in alias_sets(levels, factors, args.max_order):
        print(group.text)


def _print_words(relation: str, length: int | None) -> None:
    print(f'{relation}, resolution {_ROMAN.get(length or 0, length)}')


def _power(args: argparse.Namespace) -> None:
    design = _design(args, _treatments(args).letters)
    terms = representatives(design.levels, design.factors, args.max_order)
    runs, parameters = design.cases * args.replicates, 1 + len(terms)
    print(f'{design.cases} cases x {args.replicates} replicates, {parameters} parameters')
    smallest = smallest_effect(runs, parameters, args.sigma, args.alpha)
    print(f'Smallest effect found with 80 % power at alpha {args.alpha:g}: {smallest:.4g}')
    if args.effect is None:
        return
    found = power(args.effect, runs, parameters, args.sigma, args.alpha)
    print(f'Power for an effect of {args.effect:g}: {found:.4f} if no run fails')
    if args.failure:
        model = RunModel(args.sigma, args.failure, args.loss, args.failure_sigma or args.sigma)
        result = simulate_power(
            design.levels,
            design.factors,
            terms,
            args.effect,
            args.replicates,
            model,
            args.alpha,
            args.repeats,
            args.seed,
        )
        print(
            f'Power with {100 * args.failure:g} % failing runs: {result.power:.3f} '
            f'(standard error {result.power_se:.3f}, {result.repeats} simulated campaigns)'
        )


def _hours(args: argparse.Namespace) -> None:
    treatments = _treatments(args)
    episodes = args.episodes or treatments.base.training.episodes
    seconds, source = _seconds_per_episode(args, treatments.base, episodes)
    count = len(treatments.factors)
    found = options(Budget(args.hours, seconds, args.workers), count, episodes)
    chosen = propose(found)
    ruled = with_rule(chosen, args.sigma, args.stop_when, LEAST_ROUNDS)
    print(f'A run of {episodes} episodes: {seconds * episodes:.3g} s of a core, {source}.')
    print('Proposed:')
    print(f'{describe(chosen, episodes, args.sigma)}{ruled}')
    for option in found:
        if option is not chosen:
            print('\nInstead:')
            print(describe(option, episodes, args.sigma))


def _seconds_per_episode(
    args: argparse.Namespace, base: RunSpec, episodes: int
) -> tuple[float, str]:
    """Return the time of an episode, with its share of the evaluation, and where it is from.

    Raises:
        ValueError: Nothing tells it.
    """
    if args.seconds_per_run:
        return args.seconds_per_run / (args.run_episodes or episodes), 'as given'
    if args.measured:
        measured = read_progress(args.measured).measured
        if not measured:
            raise ValueError(f'--measured {args.measured}: no finished run, expected some')
        progress = Progress('', {run.run_id: run for run in measured})
        length = args.run_episodes or sum(run.planned for run in measured) / len(measured)
        pace = progress.runs_per_core_hour
        source = f'by {len(measured)} runs of {args.measured}, {pace:.1f} per core-hour'
        return _HOUR_S / pace / length, source
    if not is_foretold(base):
        raise ValueError(
            "expected --measured or --seconds-per-run: learner or ground is not article.yaml's"
        )
    spec = base.with_value('training.episodes', episodes, '--episodes')
    return seconds_of(spec) / episodes, 'judged by two cores of a shared EPYC host'


def leading_sets(campaign: Path) -> list[str]:
    """Return the sets that the analysis of a campaign states intervals for: its best.

    Raises:
        ValueError: The campaign cannot be analysed, or leaves no error to state an interval with.
    """
    # What `plan` needs otherwise imports none of this.
    from hexapod_doe.analysis.analysis import analyse
    from hexapod_doe.records.options import Options
    from hexapod_doe.tables.bag_table import plan_rule, read_bags

    tables = read_bags([campaign])
    found = analyse(tables[:1], Options(confirmation=plan_rule([campaign])))
    if found.confirmation is None:
        raise ValueError(
            f'{campaign}: its runs leave no error to state intervals with; name --sets'
        )
    return [check.label for check in found.confirmation.checks]


def _treatments(args: argparse.Namespace) -> Treatments:
    """Return the factors of the command line: of a file, or sensors by number or letters."""
    base, given = RunSpec.load(args.config, args.set), args.factors
    if given.isdecimal():
        return Treatments(default_factors(factor_letters(int(given))), base)
    path = Path(given).expanduser()
    letters = given.isalpha() and given.isupper()
    if not letters and (path.suffix in _FACTOR_FILES or path.is_file()):
        return read_factors(path, base)
    return Treatments(default_factors(given), base)


def _design(args: argparse.Namespace, factors: str) -> Design:
    if args.generators:
        return from_generators(args.generators, factors)
    return fraction(args.design, factors)


def _finish(plan: Plan, levels: np.ndarray, out: Path) -> None:
    """Write a plan and print what its cases can and cannot tell apart."""
    check_free(plan, out)
    write_plan(plan, out)
    settings = plan.settings
    assert settings is not None  # made here, not read
    if not plan.treatments.default:
        for factor in plan.treatments.factors:
            print(f'{factor.letter}  {factor.change}  ({factor.key})')
        for name, channel in plan.treatments.unseen(plan.levels):
            print(f'Note: {name!r} changes nothing: no case observes {channel}')
    print(f'{len(plan.rows)} runs: {settings.cases} cases x {settings.replicates} -> {out}')
    if settings.resolution is not None:
        _print_words(settings.defining_relation, settings.resolution)
    mixed = [g.text for g in alias_sets(levels, plan.factors, 2) if len(g.terms) > 1]
    print(f'Cannot separate: {"; ".join(mixed)}' if mixed else 'All terms to order 2 separate.')


_RUN: dict[str, Callable[[argparse.Namespace], None]] = {
    'make': _make,
    'fold': _fold,
    'augment': _augment,
    'confirm': _confirm,
    'aliases': _aliases,
    'power': _power,
    'hours': _hours,
}

if __name__ == '__main__':
    main()
