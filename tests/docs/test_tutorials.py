# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the tutorials have people edit works, and their tables are what the tools compute."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from hexapod_doe.designs.planner import Budget, options
from page_commands import ROOT, blocks, edited

TUTORIALS = ROOT / 'docs' / 'tutorials'
TERM = """
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.specification.run_spec import RunSpec

for weight in (0.0, 0.5):
    env = HexapodLine(config=RunSpec.load(None, [f'task.heading_weight={weight}']))
    env.reset(seed=1)
    _, reward, *_, info = env.step(env.action_space.sample() * 0)
    print(reward, info['terms']['heading'])
"""
ROW = """
from hexapod_agent.algorithms import ALGORITHMS

print(ALGORITHMS['random_search'].learner.__name__, ALGORITHMS['random_search'].stack)
"""
_ROW = re.compile(
    r'^\| ([\w ]+) \| (\d+) \| (\w+)\.yaml, (\d+) episodes \| `(\w+)` × (\d+) \| (\d+) '
    r'\| ([\d.]+) \| ([\d.]+) σ \|$',
    re.MULTILINE,
)
SECONDS = {'swift': 77.0, 'article': 818.0}
HOURS = {'thirty minutes': 0.5, 'a night': 8.0, 'a weekend': 60.0}


def told_with(folder: Path, code: str) -> list[str]:
    path = os.pathsep.join((str(folder), os.environ.get('PYTHONPATH', '')))
    told = subprocess.run(
        [sys.executable, '-c', code], env=os.environ | {'PYTHONPATH': path}, cwd=folder,
        capture_output=True, text=True, check=False, timeout=120.0,
    )  # fmt: skip
    assert told.returncode == 0, told.stderr
    return told.stdout.split()


def test_the_new_term_is_earned_and_a_weight_of_zero_changes_nothing(tmp_path: Path) -> None:
    edited(TUTORIALS / 'my_reward.md', 'hexapod_sim', tmp_path)
    without, none, reward, heading = map(float, told_with(tmp_path, TERM))
    assert (none, heading) == (0.0, pytest.approx(0.5, abs=0.01))  # the cosine of a small yaw
    assert reward == pytest.approx(without + heading)


def test_the_row_of_the_learner_finds_its_classes(tmp_path: Path) -> None:
    edited(TUTORIALS / 'my_learner.md', 'hexapod_agent', tmp_path)
    text = (ROOT / 'examples' / 'random_search.py').read_text(encoding='utf-8')
    (tmp_path / 'hexapod_agent' / 'algorithms' / 'random_search.py').write_text(text)
    assert told_with(tmp_path, ROW) == ['RandomSearch', 'None']


def test_the_path_after_the_demo_is_what_the_planner_computes() -> None:
    rows = _ROW.findall((TUTORIALS / 'index.md').read_text(encoding='utf-8'))
    assert [row[0] for row in rows] == ['thirty minutes', 'thirty minutes', 'a night', 'a weekend']
    for time, cores, learner, episodes, design, replicates, runs, hours, sees in rows:
        budget = Budget(HOURS[time], SECONDS[learner] / int(episodes), int(cores))
        offered = options(budget, 7, int(episodes))
        (found,) = [each for each in offered if each.design.name == design]
        assert (found.replicates, found.runs) == (int(replicates), int(runs))
        assert found.episodes == int(episodes)
        assert (f'{found.hours:.1f}', f'{found.sees:.2f}') == (hours, sees)


def test_its_commands_have_the_seconds_that_it_explains() -> None:
    text = (TUTORIALS / 'index.md').read_text(encoding='utf-8')
    page = (ROOT / 'docs' / 'learning.md').read_text(encoding='utf-8')
    for name, seconds in SECONDS.items():
        taken = re.findall(rf'^\| {name}\.yaml \| `ABCDE` \|.* (\d+) \|$', page, re.MULTILINE)
        for each in taken:
            assert seconds == pytest.approx(1.3 * float(each), rel=0.15)
        assert taken
        assert f'--seconds-per-run {seconds:g}' in text
        assert f'{seconds:g} s' in text


def test_the_readme_is_short() -> None:
    assert len((ROOT / 'README.md').read_text(encoding='utf-8').splitlines()) <= 160


def test_pages_hold_code_that_is_read() -> None:
    """A fence whose language nobody reads would be checked by nobody."""
    known = {'bash', 'python', 'yaml', 'diff', 'text', ''}
    for page in (ROOT / 'README.md', *TUTORIALS.glob('*.md')):
        assert set(re.findall(r'^ *```(\w+)', page.read_text(encoding='utf-8'), re.M)) <= known
    assert len(blocks(TUTORIALS / 'first_campaign.md', 'bash')) > 5
