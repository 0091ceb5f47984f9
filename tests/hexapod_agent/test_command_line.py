# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Every number and path of the commands is held to what its declaration says."""

import re
from pathlib import Path

import pytest
from hexapod_agent.learning import checkpoint

from hexapod_agent import evaluate, export, film


@pytest.fixture
def agent(make_trainer, tmp_path) -> Path:
    checkpoint.save_agent(tmp_path / 'agent.pt', make_trainer())
    return tmp_path / 'agent.pt'


@pytest.mark.parametrize(
    ('command', 'arguments', 'message'),
    [
        (evaluate, ['--starts', '0'], "--starts: '0', expected a whole number from 1"),
        (evaluate, ['--starts', 'x'], "--starts: 'x', expected a whole number from 1"),
        (evaluate, ['--seed', '-1'], "--seed: '-1', expected a whole number from 0"),
        (evaluate, ['--json', 'no/a.json'], "--json: 'no/a.json': there is no folder 'no'"),
        (evaluate, ['--json', '.'], "--json: '.' is a folder"),
        (evaluate, ['--config', 'a.yaml'], "config file 'a.yaml' not found"),
        (film, ['--seconds', 'nan'], "--seconds: 'nan', expected a number from 0.05 to 600"),
        (film, ['--seconds', '0'], "--seconds: '0', expected a number"),
        (film, ['--seconds', 'inf'], "--seconds: 'inf', expected a number"),
        (film, ['--zoom', '0'], "--zoom: '0', expected a number from 0.1 to 20"),
        (film, ['--width', '2000'], "--width: '2000', expected a whole number from 16 to 1280"),
        (film, ['--height', '0'], "--height: '0', expected a whole number from 16 to 720"),
        (film, ['--frames', '0'], "--frames: '0', expected a whole number from 1"),
        (film, ['--seed', '-1'], "--seed: '-1', expected a whole number from 0"),
        (film, ['--out', 'a.avi'], "--out: 'a.avi', expected a name that ends in .gif or .mp4"),
        (film, ['--out', 'no/a.gif'], "there is no folder 'no'"),
        (film, ['--strip', 'a.txt'], "--strip: 'a.txt', expected a name that ends in .png"),
        (export, ['no/a.onnx'], "there is no folder 'no'"),
        (export, ['.'], 'is a folder, expected the name of a file'),
    ],
)
def test_what_cannot_be_is_one_line(agent, capsys, command, arguments, message):
    with pytest.raises(SystemExit) as stopped:
        command.main([str(agent), *arguments])
    assert stopped.value.code == 2
    assert re.search(re.escape(message), capsys.readouterr().err.splitlines()[-1])


def test_the_home_folder_is_known(agent, monkeypatch):
    monkeypatch.setenv('HOME', str(agent.parent))
    export.main(['~/agent.pt', '~/agent.onnx'])
    evaluate.main(['~/agent.pt', '--starts', '1', '--json', '~/agent.json'])
    assert {'agent.onnx', 'agent.json'} <= {path.name for path in agent.parent.iterdir()}


@pytest.mark.parametrize('command', [evaluate, film, export])
def test_a_damaged_agent_is_one_line(agent, tmp_path, capsys, command):
    agent.write_bytes(agent.read_bytes()[:-100])
    out = {film: ['--out', str(tmp_path / 'a.gif')], export: [str(tmp_path / 'a.onnx')]}
    with pytest.raises(SystemExit) as stopped:
        command.main([str(agent), *out.get(command, [])])
    assert stopped.value.code == 2
    assert 'expected a whole file of `train`' in capsys.readouterr().err.splitlines()[-1]
