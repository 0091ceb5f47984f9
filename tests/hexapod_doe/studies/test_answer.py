# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The answer is rebuilt from bags alone, and the pages hold what the committed numbers say."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.campaigns.row import read_rows
from hexapod_doe.studies import answer
from hexapod_doe.studies.answer import NUMBERS, blocks
from hexapod_doe.studies.claims import AGREES, DIFFERS, OPEN
from hexapod_doe.studies.study_text import data_sheet, replace_block
from simulated import Truth
from simulated_study import finish, plan_campaign

from hexapod_doe import plan as plan_command

ROOT = Path(__file__).parents[3]
STUDY, DOCS = ROOT / 'bags' / 'study', ROOT / 'docs'
MARKED = '<!-- answer: begin -->\nstale text\n<!-- answer: end -->\nkept\n'


@pytest.fixture(scope='module')
def rebuilt(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """A study of two finished campaigns, one confirmed, and one that has not begun."""
    root = tmp_path_factory.mktemp('answer')
    study, docs = root / 'study', root / 'docs'
    docs.mkdir()
    truth = Truth(failure={'1': -50.0})
    finish(plan_campaign(study / 'main', 'quarter+eighth', 2), truth, seed=1)
    finish(plan_campaign(study / 'rough', 'eighth', 2), truth, seed=2)
    plan_campaign(study / 'stairs', 'eighth', 1)
    plan_command.main(['confirm', str(study / 'main'), '--sets', 'ABCDE,none'])
    finish(study / 'main' / 'confirm' / PLAN_FILE, truth, seed=3)
    for page in (docs / 'study.md', root / 'README.md', study / 'README.md'):
        page.write_text(MARKED)
    assert answer.main([str(study), '--out', str(docs)]) == 0
    return root, json.loads((docs / 'data' / 'study' / NUMBERS).read_text())


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_unfinished_campaigns_are_named(rebuilt: tuple[Path, dict[str, Any]]) -> None:
    root, record = rebuilt
    assert record['left_out'] == ['stairs (0 of 16 runs)']
    assert list(record['campaigns']) == ['main', 'rough']
    assert 'left out: stairs (0 of 16 runs)' in (root / 'docs' / 'study.md').read_text()


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_the_pages_say_what_the_numbers_say(rebuilt: tuple[Path, dict[str, Any]]) -> None:
    root, record = rebuilt
    main = record['campaigns']['main']
    best = main['best'][0]
    assert best['value'] == max(main['values'].values())
    for page in (root / 'README.md', root / 'docs' / 'study.md'):
        text = page.read_text()
        assert f'**{best["set"]}**' in text
        assert text.endswith('<!-- answer: end -->\nkept\n')
        assert 'stale text' not in text
    assert '| main | 80 | 40 | 2 | 3 | 0 |' in (root / 'study' / 'README.md').read_text()


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_the_effects_are_those_of_the_truth(rebuilt: tuple[Path, dict[str, Any]]) -> None:
    effects = rebuilt[1]['campaigns']['main']['effects']
    assert list(effects) == ['quarter', 'eighth']
    for found in effects.values():
        assert abs(found['C']['effect'] - 190) < 45  # twice the coefficient of 95; 3 errors


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_each_claim_has_a_verdict_by_a_rule(rebuilt: tuple[Path, dict[str, Any]]) -> None:
    claims = {each['claim']: each for each in rebuilt[1]['claims']['main']}
    assert len(claims) == 6  # two runs of a case are too few to drop three
    assert {each['verdict'] for each in claims.values()} <= {AGREES, DIFFERS, OPEN}
    assert claims['C, the body orientation, matters most']['verdict'] == AGREES
    assert claims['Two of ten trainings of a set fail']['verdict'] == DIFFERS
    assert '0 of 80 runs failed' in claims['Two of ten trainings of a set fail']['ours']


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_confirmed_sets_and_the_robust_one_are_told(
    rebuilt: tuple[Path, dict[str, Any]],
) -> None:
    root, record = rebuilt
    checks = {
        each['label']: each for each in record['campaigns']['main']['confirmation']['checks']
    }
    assert len(checks['ABCDE']['observed']) == len(checks['(none)']['observed']) == 2
    lost = record['robust']['lost']
    assert record['robust']['worst_task'] == max(lost, key=lost.__getitem__)
    assert '**Confirmation, main**' in (root / 'docs' / 'study.md').read_text()


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_figures_lie_beside_their_numbers(rebuilt: tuple[Path, dict[str, Any]]) -> None:
    docs = rebuilt[0] / 'docs'
    names = {path.stem for path in (docs / 'images').glob('*.png')}
    assert names == {f'study_{name}' for name in (
        'ranking', 'effects', 'learning', 'confirmation', 'backtest', 'atlas'
    )}  # fmt: skip
    assert names <= {path.stem for path in (docs / 'data' / 'study').glob('*.csv')}
    shown = re.findall(r'\(images/(\w+)\.png\)', (docs / 'study.md').read_text())
    assert set(shown) == names


def whole_campaigns() -> list[str]:
    plans = sorted(STUDY.glob(f'*/{PLAN_FILE}'))
    return [p.parent.name for p in plans if all(row.bag_state().done for row in read_rows(p))]


def test_the_committed_pages_are_those_of_the_committed_numbers() -> None:
    record = json.loads((DOCS / 'data' / 'study' / NUMBERS).read_text())
    assert sorted(record['campaigns']) == sorted(whole_campaigns())
    texts = blocks(record, DOCS / 'images')
    pages = {DOCS / 'study.md': texts['page'], ROOT / 'README.md': texts['readme'],
             STUDY / 'README.md': data_sheet(record)}  # fmt: skip
    for page, text in pages.items():
        written = page.read_text(encoding='utf-8')
        assert written == replace_block(written, 'answer', text)
        if not record['campaigns']:
            assert not re.search(r'\d', text.split('left out')[0])


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_the_committed_numbers_are_those_of_the_bags(tmp_path: Path) -> None:
    committed = json.loads((DOCS / 'data' / 'study' / NUMBERS).read_text())
    assert close(answer.rebuild(STUDY, tmp_path), committed)


def close(found: Any, expected: Any) -> bool:
    """Compare records; numbers as far as processors agree on them."""
    if isinstance(expected, dict):
        return found.keys() == expected.keys() and all(
            close(found[key], value) for key, value in expected.items()
        )
    if isinstance(expected, list):
        return len(found) == len(expected) and all(map(close, found, expected))
    if isinstance(expected, float):
        return bool(found == pytest.approx(expected, rel=1e-3, abs=1e-6))
    return bool(found == expected)
