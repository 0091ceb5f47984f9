# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Which runs belong together: those of one plan, and of the plans that follow it."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from hexapod_doe.bags.bag_state import sound_metadata
from hexapod_doe.bags.run_identity import plan_differences, run_identity
from hexapod_doe.bags.run_record import RunRecord, read_run
from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.campaigns.row import rows_of
from hexapod_doe.designs.plan_file import PlanError, read_plan
from hexapod_doe.designs.plan_types import Plan, PlanSettings
from hexapod_doe.errors import BagError, TableError, UnfinishedError

_NAMED = 8


@dataclass
class Part:
    """The runs of one plan, or of a folder without one."""

    folder: Path
    plan: Plan | None
    runs: list[RunRecord] = field(default_factory=list)

    @property
    def settings(self) -> PlanSettings | None:
        """How the plan was made, if that is known."""
        return self.plan.settings if self.plan else None

    @cached_property
    def expected(self) -> dict[str, dict[str, str]]:
        """What the plan says of each run, by run id."""
        rows = rows_of(self.plan, self.folder) if self.plan else ()
        return {row.run_id: row.identity for row in rows}

    def difference(self, run: RunRecord) -> str | None:
        """Say how a run differs from its row; '' if it does not, None if there is no such row."""
        expected = self.expected.get(run.run_id)
        if expected is None:
            return None
        return plan_differences(run_identity(run.metadata), expected)

    @property
    def follows(self) -> bool:
        """Whether the plan adds to another one."""
        return self.settings is not None and bool(self.settings.follows)

    @property
    def confirms(self) -> bool:
        """Whether the runs are to confirm a choice, and not to be fitted."""
        return self.settings is not None and bool(self.settings.confirms)


@dataclass
class Group:
    """Runs that are analysed as one table: a plan, and what follows it, in their order."""

    parts: list[Part]

    @property
    def title(self) -> str:
        """The name of the first campaign's folder."""
        return self.parts[0].folder.name

    @property
    def settings(self) -> PlanSettings | None:
        """How the last of the plans was made."""
        return self.parts[-1].settings

    @property
    def runs(self) -> list[RunRecord]:
        """All runs, each under a name that no other one has."""
        times = Counter(run.run_id for part in self.parts for run in part.runs)
        return [
            replace(run, run_id=f'{part.folder.name}/{run.run_id}')
            if times[run.run_id] > 1
            else run
            for part in self.parts
            for run in part.runs
        ]

    @property
    def caveats(self) -> tuple[str, ...]:
        """What a reader must know of a plan that follows one which is not here."""
        first = self.parts[0].settings
        if first is None or not first.follows:
            return ()
        return (
            f'{self.title} adds to another plan ({first.design}), whose runs are not among these: '
            'give both folders to analyse them together.',
        )


def sound_bags(bags: Sequence[Path]) -> tuple[list[Path], list[str]]:
    """Return the bags of complete runs, and a caveat on the unfinished and on the damaged ones."""
    complete: list[Path] = []
    unfinished, damaged = 0, []
    for bag in bags:
        try:
            sound_metadata(bag)
            complete.append(bag)
        except UnfinishedError:
            unfinished += 1
        except BagError as error:
            damaged.append(str(error))
    caveats = [f'{unfinished} bags of unfinished runs are left out.'] if unfinished else []
    if damaged:
        more = f' and {len(damaged) - _NAMED} more' if len(damaged) > _NAMED else ''
        caveats.append(
            f'{len(damaged)} bags are damaged and left out: {"; ".join(damaged[:_NAMED])}{more}; '
            'the command that trained them trains these rows anew.'
        )
    return complete, caveats


def group_runs(bags: Iterable[Path]) -> tuple[list[Group], list[Part], tuple[str, ...]]:
    """Return the groups of runs, the parts that confirm a choice, and what a reader must know.

    Raises:
        BagError: A bag cannot be read.
        TableError: A plan may follow either of two.
    """
    parts, caveats = _parts(bags)
    groups = [Group([part]) for part in parts if not (part.follows or part.confirms)]
    left = [part for part in parts if part.follows]
    while left:
        part = next((each for each in left if _bases(each, groups)), None)
        if part is None:
            break
        left.remove(part)
        _only_base(part, groups).parts.append(part)
    groups += [Group([part]) for part in left]
    found = [caveat for group in groups for caveat in group.caveats]
    return groups, [part for part in parts if part.confirms], (*caveats, *found)


def campaign_of(bag: Path) -> Path | None:
    """Return the campaign's folder: the nearest one above a bag that holds a plan.

    The way by which the bag was found comes first, then the one that its links lead to.
    """
    above = (*bag.absolute().parents, *bag.resolve().parents)
    return next((parent for parent in above if (parent / PLAN_FILE).is_file()), None)


def plans_in(folder: Path) -> list[Plan]:
    """Return the plans of a campaign's folder, plan.csv first; further ones share its runs.

    Raises:
        PlanError: plan.csv is no plan.
    """
    plans = [read_plan(folder / PLAN_FILE)]
    for path in sorted(folder.glob('*.csv')):
        if path.name != PLAN_FILE:
            try:
                plans.append(read_plan(path))
            except (PlanError, OSError):  # another table
                continue
    return plans


def _parts(bags: Iterable[Path]) -> tuple[list[Part], tuple[str, ...]]:
    by_folder: dict[Path | None, list[Path]] = {}
    for bag in bags:
        by_folder.setdefault(campaign_of(bag), []).append(bag)
    parts: list[Part] = []
    caveats: list[str] = []
    for folder, found in by_folder.items():
        runs = [read_run(bag) for bag in found]
        if folder is None:
            parts.append(Part(found[0].parent.resolve(), None, runs))
            continue
        own = [Part(folder, plan) for plan in plans_in(folder)]
        caveats += _share_out(runs, own)
        parts += [part for part in own if part.runs]
    return parts, tuple(caveats)


def _share_out(runs: Sequence[RunRecord], parts: Sequence[Part]) -> list[str]:
    """Give each run to the plan whose row it is, one of no plan to the first.

    Returns:
        A caveat where runs are left out, as the row of their name is another run.
    """
    odd = []
    for run in runs:
        found = [(part, part.difference(run)) for part in parts]
        own = next((part for part, difference in found if difference == ''), None)
        other = next((difference for _, difference in found if difference), '')
        if own is None and other:
            odd.append(f'{run.run_id} ({other})')
        else:
            (own or parts[0]).runs.append(run)
    if not odd:
        return []
    more = f' and {len(odd) - _NAMED} more' if len(odd) > _NAMED else ''
    return [
        f'{len(odd)} bags are left out, as the plan in {parts[0].folder} says otherwise of their '
        f'runs: {"; ".join(odd[:_NAMED])}{more}.'
    ]


def _only_base(part: Part, groups: Sequence[Group]) -> Group:
    found = _bases(part, groups)
    if len(found) > 1:
        names = ', '.join(str(group.parts[0].folder) for group in found)
        raise TableError(
            f'{part.folder}: its plan may follow that of any of {names}; give one of them'
        )
    return found[0]


def _bases(part: Part, groups: Sequence[Group]) -> list[Group]:
    """Return the groups with the plan that a part adds to."""
    return [group for group in groups if any(_adds_to(part, base) for base in group.parts)]


def _adds_to(part: Part, base: Part) -> bool:
    """Whether a plan follows another: it says so, or (an older one) numbers on from it."""
    if part.plan is None or base.plan is None or part.settings is None:
        return False
    if part.settings.predecessor:
        return part.settings.predecessor == base.plan.fingerprint
    after = part.plan.rows['StdOrder'].min() == 1 + base.plan.rows['StdOrder'].max()
    return bool(after) and part.plan.factors == base.plan.factors
