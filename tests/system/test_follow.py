# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A checkpoint follows a jumping line: one launch, its bag and the report of it."""

from __future__ import annotations

import pytest
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_doe.bags.run_record import read_run
from hexapod_doe.replays.follow import read_track, responses

pytestmark = pytest.mark.system
LAUNCH = 'ros2 launch hexapod_bringup follow.launch.xml'


@pytest.fixture
def ready(shell):
    """Write an untrained checkpoint, and a line that jumps after one second and after two."""
    config = RunSpec.from_mapping({'actor': {'hidden': [8, 8]}}, 'test')
    trainer = Trainer(config.observing('C'), 3)
    checkpoint.save_agent(shell.directory / 'agent.pt', trainer)
    (shell.directory / 'jumps.yaml').write_text(
        'task: {time_limit_steps: 100, line_jump: 0.3, line_period: 1.0, start_offset: 0.0}\n'
    )
    return shell


@pytest.mark.parametrize('composed', ['true', pytest.param('false', marks=pytest.mark.slow)])
def test_launch_records_and_reports(ready, composed: str) -> None:
    line = f'{LAUNCH} checkpoint:=agent.pt config:=jumps.yaml bag:=bag composed:={composed}'
    ended = ready.run(line)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    bag = ready.directory / 'bag'
    assert read_run(bag).metadata['mode'] == 'play'
    track = read_track(bag)
    assert track.time.size == 101
    assert track.line[[0, 39, 40, 79, 80]] == pytest.approx([-0.3, -0.3, 0.3, 0.3, -0.3])
    report = ready.call('ros2 run hexapod_doe follow_report bag --out follow.svg')
    assert report.returncode == 0, report.stderr
    assert '+0.60' in report.stdout
    assert (ready.directory / 'follow.svg').is_file()


def test_the_shipped_agent_follows_a_line_that_jumps_by_a_metre(shell) -> None:
    (shell.directory / 'jumps.yaml').write_text(
        'task: {time_limit_steps: 1000, line_jump: 0.5, line_period: 12.0, start_offset: 0.0}\n'
    )
    ended = shell.run(f'{LAUNCH} config:=jumps.yaml bag:=bag', timeout_s=180.0)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    track = read_track(shell.directory / 'bag')
    first = responses(track)[0]
    assert first.jump == pytest.approx(1.0)
    assert first.settling_time < 10.0
    assert first.offset_after < 0.1


def test_a_second_launch_names_what_to_give(ready) -> None:
    (ready.directory / 'bags' / 'follow').mkdir(parents=True)
    ended = ready.run(f'{LAUNCH} checkpoint:=agent.pt')
    output = ended.stdout + ended.stderr
    assert ended.returncode != 0
    assert "bag 'bags/follow' is there already" in output
    assert 'bag:=' in output
    assert 'Traceback' not in output


def test_a_missing_checkpoint_ends_the_launch(ready) -> None:
    ended = ready.run(f'{LAUNCH} checkpoint:=none.pt bag:=bag')
    assert ended.returncode != 0
    assert 'none.pt' in ended.stdout + ended.stderr
    assert not (ready.directory / 'bag').exists()
