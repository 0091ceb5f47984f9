# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The examples run, and print what their data hold; the notebook's cells in order."""

import json
import runpy
import sys
from pathlib import Path

import matplotlib
import pytest
from hexapod_agent.algorithms import ALGORITHMS
from hexapod_doe.bags.run_record import read_topic
from page_commands import ROOT

EXAMPLES = ROOT / 'examples'
NOTEBOOK = EXAMPLES / 'sample.ipynb'


@pytest.fixture
def run(project: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    """Return what runs a script with words, and gives what it printed."""

    def run(name: str, *words: str) -> str:
        monkeypatch.setattr(sys, 'argv', [name, *words])
        monkeypatch.syspath_prepend(EXAMPLES)
        runpy.run_path(str(EXAMPLES / name), run_name='__main__')
        return capsys.readouterr().out

    return run


def test_a_bag_is_read(run) -> None:
    told = run('read_bag.py', 'bags/sample')
    assert 'run sample, sensors ABCDE' in told
    assert '601 samples' in told  # an episode of 600 periods, and its start


def test_a_campaign_is_analysed(run) -> None:
    told = run('analyse_campaign.py', 'bags/sample_campaign')
    assert 'C body orientation: +15.6 ± 7.8' in told  # of bags that do not change
    assert 'OLS Regression Results' in told


def test_the_shipped_agent_walks_closer_than_the_zero_action(run) -> None:
    told = run('walk.py', '--starts', '1').splitlines()
    agent, zero = (float(line.split(', ')[1].split()[0]) for line in told)
    assert agent < zero


def test_an_algorithm_of_ones_own_trains(run, project: Path) -> None:
    short = ['--set', 'task.time_limit_steps=48', '--set', 'training.evaluation=1']
    run('random_search.py', '--episodes', '2', '--out', 'runs/search', *short)
    assert (project / 'runs' / 'search' / 'agent.pt').is_file()
    assert 'random_search' not in ALGORITHMS  # its row was lent


@pytest.mark.graph
def test_a_node_of_ones_own_hears_the_feet(monkeypatch: pytest.MonkeyPatch) -> None:
    import rclpy
    from geometry_msgs.msg import WrenchStamped

    monkeypatch.syspath_prepend(EXAMPLES)
    from listen import LEGS, FootLoads

    context = rclpy.Context()
    rclpy.init(context=context)
    try:
        node = FootLoads(context)
        for leg in LEGS:
            forces = [
                m.wrench.force.z for _, m in read_topic(ROOT / 'bags/sample', f'foot_force/{leg}')
            ]
            for force in forces[:40]:
                message = WrenchStamped()
                message.wrench.force.z = force
                node.hear(leg, message)
        # The robot weighs 2.4 kg, and its feet carry it.
        assert sum(node.loads.values()) == pytest.approx(2.4 * 9.81, rel=0.15)
        node.destroy_node()
    finally:
        context.shutdown()


def test_the_notebook_runs_from_top_to_bottom(project: Path) -> None:
    matplotlib.use('agg')
    cells = json.loads(NOTEBOOK.read_text(encoding='utf-8'))['cells']
    names: dict[str, object] = {'__name__': '__main__'}
    for number, cell in enumerate(cells):
        if cell['cell_type'] == 'code':
            exec(compile(''.join(cell['source']), f'{NOTEBOOK.name} {number}', 'exec'), names)
    assert len(names['times']) == 601
    assert names['offset'].min() < 0 or names['offset'].max() > 0
    assert abs(names['contacts'].mean() - 0.5) < 0.25


def test_the_notebook_is_kept_without_outputs() -> None:
    cells = json.loads(NOTEBOOK.read_text(encoding='utf-8'))['cells']
    assert not any(cell.get('outputs') for cell in cells)


def test_the_page_names_every_example() -> None:
    page = (EXAMPLES / 'README.md').read_text(encoding='utf-8')
    files = {path.name for pattern in ('*.py', '*.ipynb') for path in EXAMPLES.glob(pattern)}
    assert {name for name in files if f'[{name}]({name})' not in page} == set()
    assert len(files) == 6
