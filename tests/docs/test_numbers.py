# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Numbers that pages quote are those of the files, tables and constants that they are from."""

import re
import statistics

import pytest
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_doe.bags.run_record import find_bags, read_run
from hexapod_doe.designs.design import fraction
from hexapod_sim.robot import CONTROL_PERIOD_NS
from page_commands import ROOT

_REFERENCE = re.compile(
    r'^\| (`ABCDE`|always-on alone) \| \d \| \d+ \| ([+-][\d.]+)% \| ([\d.]+) '
    r'\| [\d.]+ \| (\d+) \|$',
    re.MULTILINE,
)


def page(name: str) -> str:
    return (ROOT / name).read_text(encoding='utf-8')


@pytest.fixture(scope='module')
def reference() -> dict[str, list[tuple[float, float, int]]]:
    """Per set: by how much a seed is above the constant action, %, its offset, m, its falls."""
    table: dict[str, list[tuple[float, float, int]]] = {}
    for name, over, offset, falls in _REFERENCE.findall(page('docs/learning.md')):
        table.setdefault(name, []).append((float(over), float(offset), int(falls)))
    return table


def test_the_readme_says_what_the_reference_trainings_earned(reference) -> None:
    seen, blind = reference['`ABCDE`'], reference['always-on alone']
    assert len(seen) == len(blind) == 5
    over = [row[0] for row in seen]
    said = f'all five earn {min(over):.0f} to {max(over):.0f} % more than the best constant action'
    text = page('README.md')
    assert said in text
    assert max(row[1] for row in seen) <= 0.03
    assert 'within 3 cm of the line' in text
    assert sum(row[2] for row in seen) == 0
    assert [row[0] < -40 for row in blind].count(True) == 1
    assert 'one seed of five is in ruins' in text


def test_the_readme_says_what_the_short_training_costs_and_gives() -> None:
    learning, readme = page('docs/learning.md'), page('README.md')
    found = re.findall(r'^\| `ABCDE` \| \d \| (\d+) \|', learning, re.MULTILINE)
    returns = [float(value) for value in found]
    proof = {
        name: cells.split(' | ')
        for name, cells in re.findall(
            r'^\| (\w+)\.yaml \| `ABCDE` \| (\d+ \| .*) \|$', learning, re.MULTILINE
        )[:2]
    }
    assert len(returns) == 5
    mean, deviation = statistics.mean(returns), statistics.stdev(returns)
    assert f'| {mean:.0f}, {deviation:.0f} (5 seeds) | {proof["article"][-1]} |' in readme
    count, mean_return, spread, _, failed, _, seconds = proof['swift']
    assert failed == '0'
    said = f'| {mean_return}, {spread} ({count} seeds, none failed) | {seconds} |'
    assert said in readme


@pytest.mark.parametrize(
    ('name', 'design', 'replicates', 'said'),
    [
        ('README.md', 'eighth', 1, 'eighth fraction ({cases} sensor sets)'),
        ('README.md', 'quarter', 10, 'These are {runs} trainings'),
        ('docs/tutorials/index.md', 'quarter', 10, '{cases} sets, ten trainings each'),
        ('docs/tutorials/batch.md', 'quarter', 10, '--array=1-{runs}%64'),
        ('docs/tutorials/batch.md', 'quarter', 10, 'completions: {runs}'),
    ],
)
def test_sizes_of_campaigns(name: str, design: str, replicates: int, said: str) -> None:
    cases = fraction(design).cases
    assert said.format(cases=cases, runs=cases * replicates) in page(name)


def test_control_periods_and_episodes() -> None:
    spec = RunSpec.load()
    rate, length = 1e9 / CONTROL_PERIOD_NS, spec.task.time_limit_steps * CONTROL_PERIOD_NS * 1e-9
    for name in ('README.md', 'docs/tutorials/real_robot.md'):
        assert f'at {rate:.0f} Hz' in page(name)
    assert f'four episodes of {length:.0f} s' in page('README.md')
    assert 'A control period lasts 25 ms' in page('docs/architecture.md')


def test_sizes_of_observations() -> None:
    none, some, every = (ObservationSpec(letters).size for letters in ('', 'ABCDE', 'ABCDEFG'))
    said = f'Channels marked *always* make {none} numbers, all letters {every}, `ABCDE` {some}.'
    assert said in page('docs/sensors.md')


def test_configurations_that_tutorials_quote() -> None:
    swift = RunSpec.load(ROOT / 'hexapod_agent' / 'hexapod_agent' / 'swift.yaml')
    share = swift.value('learner.ddpg.update_ratio')
    text = page('docs/tutorials/index.md')
    assert f'swift.yaml, {swift.training.episodes} episodes' in text
    assert 'eight times the updates' in text
    assert share == pytest.approx(1 / 8)


def test_the_rate_at_which_a_robot_rises() -> None:
    default = re.search(r'^\| `stop_rate` \| `([\d.]+)` \|', page('docs/interfaces.md'), re.M)
    assert default
    assert f'at `stop_rate` ({default[1]} rad/s)' in page('docs/tutorials/real_robot.md')


def test_what_the_notebook_says_of_the_sample_campaign() -> None:
    bags = find_bags(ROOT / 'bags' / 'sample_campaign')
    assert len(bags) == 8
    assert 'eight short trainings of three sensors' in page('examples/sample.ipynb')
    assert len(read_run(ROOT / 'bags' / 'sample').episodes) == 2
