# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A checkpoint, played on the graph and recorded, chooses the same again from the bag alone."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hexapod_agent.deployment import agent_file
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.nodes.agent_node import AgentNode
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_cpg.nodes.cpg_node import CpgNode
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.errors import BagError
from hexapod_doe.nodes.recorder_node import RecorderNode
from hexapod_doe.nodes.shadow_node import ShadowNode
from hexapod_doe.replays.episodes import Series, recorded_episodes
from hexapod_doe.replays.shadowing import COMMAND, COMMAND_TYPE, Recorded, shadow
from hexapod_doe.shadow import main
from hexapod_interfaces.action import TrainRun
from hexapod_node.coroutines import start
from hexapod_sim.nodes.sim_node import SimNode
from hexapod_sim.sensor_table import LETTERS

pytestmark = pytest.mark.graph
STEPS = 40
SMALL = {
    'task': {'time_limit_steps': STEPS},
    'actor': {'hidden': [16, 12]},
    'critic': {'hidden': [16, 12]},
}


def save_agent(path: Path, letters: str, seed: int) -> Path:
    """Save an untrained agent whose observation decides its action."""
    trainer = Trainer(RunSpec.from_mapping(SMALL, 'small').observing(letters), seed)
    trainer.learner.networks.actor_parameters.flat.mul_(4.0)
    checkpoint.save_agent(path, trainer)
    return path


@pytest.fixture
def bag(graph, tmp_path) -> Path:
    """The bag of two episodes that agent.pt played, both sampled."""
    agent = save_agent(tmp_path / 'agent.pt', LETTERS, 5)
    graph.add(SimNode(), CpgNode(), RecorderNode(), AgentNode())
    goal = TrainRun.Goal(run_id='r', checkpoint=str(agent), seed=9, bag=str(tmp_path / 'r'))
    goal.spec = 'training: {episodes: 2}'
    goal.record_every = 1
    response = graph.train(goal)
    assert response.result.message == ''
    return tmp_path / 'r'


def run(bag: Path, agent: Path, *options: str) -> tuple[int, list[dict]]:
    """Return the status and the figures of the command."""
    out = bag.with_name('figures.json')
    with pytest.raises(SystemExit) as end:
        main([str(bag), '--checkpoint', str(agent), '--json', str(out), *options])
    return int(end.value.code), json.loads(out.read_text())


def test_the_agent_that_played_and_another(bag: Path, tmp_path, capsys) -> None:
    status, rows = run(bag, tmp_path / 'agent.pt')
    whole = {'periods': STEPS, 'equal': STEPS, 'aged': 0, 'first': None, 'largest': None}
    assert (status, rows) == (0, [{'episode': number} | whole for number in (0, 1)])

    status, (row,) = run(bag, save_agent(tmp_path / 'other.pt', 'AB', 6), '--episode', '1')
    assert (status, row['episode'], row['periods']) == (1, 1, STEPS)
    assert row['equal'] < STEPS
    assert row['first']['period'] == 0
    sizes = [abs(row[which]['shadow'] - row[which]['recorded']) for which in ('first', 'largest')]
    assert 0.0 < sizes[0] <= sizes[1]
    assert 'instead of' in capsys.readouterr().out


@pytest.mark.system
def test_the_live_agent_node_repeats_the_bag_too(bag: Path, tmp_path) -> None:
    out = tmp_path / 'live.json'
    command = [sys.executable, '-m', 'hexapod_doe.shadow', bag, '--graph', '--json', out]
    command += ['--checkpoint', tmp_path / 'agent.pt']
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    rows = json.loads(out.read_text())
    assert [(row['episode'], row['periods'], row['equal']) for row in rows] == [
        (0, STEPS, STEPS),
        (1, STEPS, STEPS),
    ]


def test_one_other_action_is_found_and_the_rest_stays_equal(bag: Path, tmp_path) -> None:
    trainer = agent_file.load(tmp_path / 'agent.pt')
    policy = trainer.policy
    calls = 0

    def slips_once(observation):
        nonlocal calls
        calls += 1
        action = policy(observation).copy()
        if calls == 8:  # the next action sees what the robot was told, not this
            action[5 * 2] = np.nextafter(action[5 * 2], np.float32(0.0))
        return action

    recorded = Recorded(BagFile(bag), trainer.spec)
    span = recorded_episodes(BagFile(bag), recorded.commands)[0]
    found = shadow(recorded, span, slips_once, trainer.config.cpg)
    assert (found.periods, found.equal) == (STEPS, STEPS - 1)
    assert found.first == found.largest
    assert (found.first.period, found.first.field) == (7, 'hip_gain of lr')
    assert 0.0 < found.first.size < 1e-7


def test_what_cannot_be_shadowed_is_one_line(bag: Path, tmp_path, capsys) -> None:
    for options, complaint in (
        ([bag, '--checkpoint', tmp_path / 'none.pt'], 'none.pt'),
        ([bag, '--checkpoint', tmp_path / 'agent.pt', '--episode', '7'], 'it has 0, 1'),
        ([tmp_path, '--checkpoint', tmp_path / 'agent.pt'], 'is a folder with one bag below it'),
    ):
        with pytest.raises(SystemExit) as end:
            main([str(option) for option in options])
        assert end.value.code == 2
        assert complaint in capsys.readouterr().err.splitlines()[-1]


SAMPLE = Path(__file__).resolve().parents[2] / 'bags' / 'sample'


@pytest.mark.usefixtures('own_domain')  # rclpy leaves action servers of other tests behind
def test_without_an_agent_the_shadow_says_so(graph) -> None:
    bag = BagFile(SAMPLE)
    spans = recorded_episodes(bag, Series(bag, COMMAND, COMMAND_TYPE))
    node = graph.add(ShadowNode(bag, spans, ObservationSpec('')))
    with pytest.raises(BagError, match=r'/play_run: no server within 0\.1 s'):
        graph.result(start(node.play(SAMPLE / 'agent.pt', timeout_s=0.1)))
