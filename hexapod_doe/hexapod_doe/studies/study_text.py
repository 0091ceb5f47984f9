# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The texts of a study: tables in Markdown, each written from the record of its numbers alone."""

from collections.abc import Mapping, Sequence
from typing import Any

from hexapod_doe.reporting.formats import (
    MISSING,
    chance,
    interval,
    number,
    percent,
    signed,
)
from hexapod_doe.studies.study_data import ARTICLE, MAIN

_NOTHING = 'No campaign of the study is finished yet.'
_COLUMNS = {MAIN: 'ours', ARTICLE: "ours, the article's learner"}


def replace_block(text: str, marker: str, block: str) -> str:
    """Return the text with what stands between the markers replaced.

    Raises:
        ValueError: The markers are missing.
    """
    begin, end = f'<!-- {marker}: begin -->', f'<!-- {marker}: end -->'
    if begin not in text or end not in text:
        raise ValueError(f'no {begin} … {end} in the text')
    head, rest = text.split(begin, 1)
    return f'{head}{begin}\n{block}\n{end}{rest.split(end, 1)[1]}'


def headline(record: Mapping[str, Any]) -> str:
    """Return the answer in a few sentences, for the head of the README."""
    main = record['campaigns'].get(MAIN)
    if main is None:
        return 'The experiment is not finished: there is no answer yet.'
    best, cheapest, gain = main['best'][0], main['cheapest'], main['against_all']
    parts = [
        f'**{_set(best["set"])}**: of all 128 sets of seven sensors it is predicted to earn most, '
        f'{number(best["value"])} ({_level(main)} {interval(best["ci"])}), by {main["runs"]} '
        f'trainings of {main["cases"]} sets; the chance that it is the best is '
        f'{chance(main["p_best"])}.'
    ]
    if gain and best['set'] != _all_of(main):
        parts.append(
            f'All seven sensors together earn {signed(-gain["fit"])} against it '
            f'({interval([-bound for bound in reversed(gain["ci"])])}).'
        )
    if cheapest and cheapest['set'] != best['set']:
        parts.append(
            f'The cheapest set that is not worse is **{_set(cheapest["set"])}** '
            f'({number(cheapest["cost"])} {cheapest["currency"]}).'
        )
    if record['robust']:
        robust = record['robust']
        tasks = len(robust['lost'])
        parts.append(
            f'Over {tasks} tasks **{_set(robust["set"])}** loses least in the worst, '
            f'{robust["worst_task"]}: {percent(max(robust["lost"].values()), 1)}.'
        )
    if record['backtest']:
        parts.append(record['backtest']['rule'])
    return ' '.join(parts)


def answer_tables(record: Mapping[str, Any]) -> str:
    """Return all tables of the study's page."""
    if not record['campaigns']:
        return f'{_NOTHING}{_left_out(record)}'
    sections = [
        f'{headline(record)}{_left_out(record)}',
        '**By task**\n\n' + _by_task(record['campaigns']),
        *_robust(record['robust']),
        *_claims(record['claims']),
        *(_effects(name, each) for name, each in record['campaigns'].items()),
        *(_confirmation(name, each) for name, each in record['campaigns'].items()),
    ]
    return '\n\n'.join(section for section in sections if section)


def data_sheet(record: Mapping[str, Any]) -> str:
    """Return when and with what each campaign was made."""
    if not record['campaigns']:
        return f'{_NOTHING}{_left_out(record)}'
    rows = [
        (
            name, f'{each["runs"]}', f'{each["cases"]}', _replicates(each), f'{each["episodes"]}',
            f'{each["failures"]}', f'{each["made"]["began"]} to {each["made"]["ended"]}',
            _code(commit[:12] for commit in each["made"]["commits"]),
            '; '.join(each['made']['processors']),
        )
        for name, each in record['campaigns'].items()
    ]  # fmt: skip
    head = ('campaign', 'runs', 'cases', 'runs of a case', 'episodes', 'failed', 'when', 'commit',
            'processor')  # fmt: skip
    return table(head, rows) + _left_out(record)


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = [head, ['---'] * len(head), *rows]
    return '\n'.join(f'| {" | ".join(cell.replace("|", "/") for cell in row)} |' for row in lines)


def _left_out(record: Mapping[str, Any]) -> str:
    if not record['left_out']:
        return ''
    return f'\n\nNot finished, and left out: {", ".join(record["left_out"])}.'


def _by_task(campaigns: Mapping[str, Any]) -> str:
    head = ('campaign', 'runs', 'best set', 'predicted', 'chance to be best', 'expected loss',
            'cheapest set not worse', 'cost', 'failed runs')  # fmt: skip
    return table(head, [_task_row(name, each) for name, each in campaigns.items()])


def _task_row(name: str, each: Mapping[str, Any]) -> list[str]:
    best, cheapest = each['best'][0], each['cheapest']
    return [
        name,
        f'{each["runs"]}',
        _set(best['set']),
        f'{number(best["value"])} ({interval(best["ci"])})',
        chance(each['p_best']),
        number(each['expected_loss']),
        _set(cheapest['set']) if cheapest else MISSING,
        f'{number(cheapest["cost"])} {cheapest["currency"]}' if cheapest else MISSING,
        f'{each["failures"]}',
    ]


def _robust(robust: Mapping[str, Any] | None) -> list[str]:
    if robust is None:
        return []
    lost = ', '.join(f'{name} {percent(share, 1)}' for name, share in robust['lost'].items())
    return [
        f'**Robust over tasks**: {_set(robust["set"])} loses least in its worst task, '
        f'{robust["worst_task"]}; share of the best that it loses: {lost}.'
    ]


def _claims(claims: Mapping[str, Any]) -> list[str]:
    if not claims:
        return []
    by_claim: dict[str, dict[str, Any]] = {}
    for name, found in claims.items():
        for each in found:
            by_claim.setdefault(each['claim'], {})[name] = each
    head = ['claim', 'theirs', *(_COLUMNS[name] for name in claims)]
    rows = [
        [claim, next(iter(found.values()))['theirs'], *(_verdict(found.get(n)) for n in claims)]
        for claim, found in by_claim.items()
    ]
    rules = [
        f'- {claim}: {next(iter(found.values()))["rule"]}.' for claim, found in by_claim.items()
    ]
    text = '**Against the article**\n\n' + table(head, rows)
    return [text, 'When a campaign agrees:\n\n' + '\n'.join(rules)]


def _verdict(claim: Mapping[str, str] | None) -> str:
    return MISSING if claim is None else f'**{claim["verdict"]}**: {claim["ours"]}'


def _effects(name: str, each: Mapping[str, Any]) -> str:
    fractions = list(each['effects'])
    rows = [
        [
            f'{letter} {each["factors"].get(letter, "")}'.strip(),
            *(_effect(each['effects'][fraction][letter]) for fraction in fractions),
        ]
        for letter in each['effects'][fractions[0]]
    ]
    title = f'**Effects, {name}** (response with the sensor less that without it)'
    return f'{title}\n\n{table(["sensor", *fractions], rows)}'


def _effect(found: Mapping[str, float]) -> str:
    return f'{signed(found["effect"])} ({interval((found["low"], found["high"]))})'


def _confirmation(name: str, each: Mapping[str, Any]) -> str:
    found = each['confirmation']
    done = [check for check in found['checks'] if check['observed']] if found else []
    if not done:
        return ''
    rows = [
        [
            _set(check['label']), number(check['predicted']), interval(check['interval']),
            f'{len(check["observed"])}', number(check['observed_mean']),
            'confirmed' if check['passed'] else 'not confirmed',
        ]
        for check in done
    ]  # fmt: skip
    head = ('set', 'predicted', 'interval', 'new runs', 'their mean', 'verdict')
    return f'**Confirmation, {name}**: {found["rule"]}\n\n{table(head, rows)}'


def _replicates(each: Mapping[str, Any]) -> str:
    low, high = each['replicates']
    return f'{low}' if low == high else f'{low} to {high}'


def _code(words: Any) -> str:
    return ', '.join(f'`{word}`' for word in words if word)


def _set(label: str) -> str:
    return 'no further sensor' if label == '(none)' else label


def _all_of(each: Mapping[str, Any]) -> str:
    return ''.join(each['factors'])


def _level(each: Mapping[str, Any]) -> str:
    return f'{percent(each["level"])} interval'
