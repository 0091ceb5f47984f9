# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Recorded episodes earn what the task itself gives for the same walk, to the last bit."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.run_record import read_run, read_topic
from hexapod_doe.errors import BagError
from hexapod_doe.replays.rescoring import recorded_config, rescore
from hexapod_doe.rescore import main
from hexapod_sim.sums import ordered_sum
from hexapod_sim.task import DIVERGED, judge
from hexapod_sim.task_config import TaskConfig

from hexapod_doe import shadow

SAMPLE = Path(__file__).resolve().parents[3] / 'bags' / 'sample'
SHORT = TaskConfig.of_article(time_limit_steps=40)
# Values that change every term.
OTHER = replace(
    SHORT,
    velocity_weight=2.0,
    velocity_scale=0.2,
    closeness_weight=3.0,
    orientation_weight=0.7,
    orientation_scale=0.2,
    yaw_share=0.5,
    height_weight=0.1,
    walking_height=0.12,
    alive_reward=0.3,
)


def scores(bag, config):
    return list(rescore(BagFile(bag), config))


def test_the_shipped_recording_comes_out_the_same():
    bag = BagFile(SAMPLE)
    (scored,) = rescore(bag, recorded_config(bag).task)
    _, *messages = [message for _, message in read_topic(SAMPLE, 'step_outcome')]
    assert (scored.episode, len(scored.outcomes), scored.cause) == (1, 600, 'time_limit')
    # By the names that the recording has: a term that was added since earned nothing then.
    for outcome, message in zip(scored.outcomes, messages, strict=True):
        found = {name: outcome.terms[name] for name in message.term_names}
        assert list(found.values()) == list(message.term_values)
        assert ordered_sum(found.values()) == message.reward
    result = read_run(SAMPLE).episodes.loc[1]
    assert scored.recorded_return == result.episode_return
    for name in messages[0].term_names:
        assert scored.terms[name] == result[f'term_{name}']


def test_a_bad_line_sensor_does_not_change_the_score(record):
    def err(name, step, message):
        if name == 'line_offset':
            message.offset += 0.3

    bag, played = record(SHORT, change=err, sensors={'line_offset': {'bias': 0.3}})
    assert [list(row.outcomes) for row in scores(bag, SHORT)] == played


def test_every_episode_gets_the_outcomes_of_the_task(record):
    bag, played = record(SHORT, seeds=(1, 2))
    scored = scores(bag, SHORT)
    assert [row.episode for row in scored] == [0, 1]
    assert [list(row.outcomes) for row in scored] == played


def test_heights_are_those_above_the_recorded_ground(record):
    """In 80 steps the body comes to be above the first stair."""
    task = replace(SHORT, time_limit_steps=80)
    bag, played = record(task, scene={'name': 'stairs', 'run_up': 0.3})
    assert [list(row.outcomes) for row in scores(bag, task)] == played
    z = [odometry.pose.pose.position.z for _, odometry in read_topic(bag, 'odom')]
    above_the_floor = judge(80, (0.0, 0.0, z[-1], 0.0, 0.0, 0.0), 0.0, 0.0, task).terms['height']
    assert played[0][-1].terms['height'] != above_the_floor


def test_another_reward_is_that_of_a_task_that_has_it(record, tmp_path):
    bag, _ = record(SHORT)
    (scored,) = scores(bag, OTHER)
    assert scored.equal == 0
    (tmp_path / 'walk').rename(tmp_path / 'first')
    _, (played,) = record(OTHER)  # the same walk: what is earned moves nothing
    assert list(scored.outcomes) == played


def test_a_line_that_jumps_shifts_the_distances(record):
    bag, _ = record(SHORT)
    (scored,) = scores(bag, replace(SHORT, line_jump=0.5, line_period=0.5))
    # At -0.5 m, and in turn every 20 steps, 0.5 s, at +0.5 m; recorded with the line at 0 m.
    offsets = [message.offset for _, message in read_topic(bag, 'line_offset')]
    lines = [-0.5] * 20 + [0.5] * 20 + [-0.5]
    weight = SHORT.closeness_weight
    expected = [weight * (1.0 - abs(o - line)) for o, line in zip(offsets, lines, strict=True)]
    found = [outcome.terms['closeness'] for outcome in scored.outcomes]
    assert found == pytest.approx(expected[1:], abs=1e-14)


def test_limits_end_an_episode_earlier_and_a_recording_cannot_be_longer(record):
    bag, (played,) = record(SHORT)
    (early,) = scores(bag, replace(SHORT, time_limit_steps=10))
    assert (len(early.outcomes), early.cause) == (10, 'time_limit')
    (strayed,) = scores(bag, replace(SHORT, max_offset=1e-6))
    assert (len(strayed.outcomes), strayed.cause) == (1, 'strayed')
    (longer,) = scores(bag, replace(SHORT, time_limit_steps=100))
    assert (len(longer.outcomes), longer.cause) == (40, '')
    assert longer.episode_return == ordered_sum(outcome.reward for outcome in played)


def test_an_episode_whose_physics_was_lost_stays_so(record):
    def lose_physics(name, step, message):
        if name == 'step_outcome' and step == 40:
            message.cause, message.reward = DIVERGED, 0.0

    bag, _ = record(SHORT, change=lose_physics)
    (scored,) = scores(bag, SHORT)
    assert scored.outcomes[-1].cause == DIVERGED
    assert scored.equal == 40


@pytest.mark.parametrize('leave_out', [('step_outcome',), ('step_outcome', 'line_offset')])
def test_a_bag_without_rewards_or_line_is_scored_all_the_same(record, leave_out):
    bag, (played,) = record(SHORT, leave_out=leave_out)
    (scored,) = scores(bag, SHORT)
    assert list(scored.outcomes) == played
    assert (scored.equal, scored.recorded_return) == (0, None)


@pytest.mark.parametrize(
    ('fault', 'complaint'),
    [
        ({'lose': ('line_offset', 7)}, 'episode 0 has other stamps on /w/line_offset'),
        ({'lose': ('step_outcome', 0)}, '/w/step_outcome has no step 0'),
        ({'leave_out': ('odom',)}, "topic 'odom' expected"),
    ],
)
def test_what_cannot_be_scored_is_one_line(record, capsys, fault, complaint):
    bag, _ = record(SHORT, **fault)
    with pytest.raises(BagError, match=complaint):
        scores(bag, SHORT)
    with pytest.raises(SystemExit):
        main([str(bag)])
    assert f'rescore: error: bag {bag}: ' in capsys.readouterr().err


def test_command_line(record, tmp_path, capsys):
    bag, (played,) = record(SHORT)
    main([str(bag)])
    assert '40 of 40 recorded rewards come out the same' in capsys.readouterr().out
    (tmp_path / 'other.yaml').write_text('task: {alive_reward: 0.5}')
    out = tmp_path / 'scores.json'
    main([str(tmp_path), '--task', str(tmp_path / 'other.yaml'), '--json', str(out)])
    told = capsys.readouterr().out
    assert 'Another task than the recorded one' in told
    assert 'come out the same' not in told
    (row,) = json.loads(out.read_text())
    assert row['run_id'] == 'walk'
    assert row['terms']['alive'] == 20.0
    assert row['recorded_return'] == sum(outcome.reward for outcome in played)
    assert row['return'] == pytest.approx(row['recorded_return'] - (SHORT.alive_reward - 0.5) * 40)


def test_an_unknown_key_of_the_reward_file_is_named(tmp_path, capsys):
    (tmp_path / 'wrong.yaml').write_text('task: {alive: 0.5}')
    with pytest.raises(SystemExit):
        main([str(SAMPLE), '--task', str(tmp_path / 'wrong.yaml')])
    assert "wrong.yaml: unknown key 'task.alive'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ('command', 'fault'),
    [('rescore', 'zeros')]
    + [(c, f) for c in ('rescore', 'shadow') for f in ('truncated', 'foreign', 'empty')],
)
def test_an_unusable_bag_is_one_line(record, capsys, command, fault):
    bag, _ = record(SHORT)
    (file,) = bag.glob('*.mcap')
    content = bytearray(file.read_bytes())
    if fault == 'truncated':
        file.write_bytes(content[:-100])
    elif fault == 'foreign':
        (bag / 'metadata.yaml').write_text('rosbag2_bagfile_information: {storage_identifier: x}')
    elif fault == 'empty':
        file.write_bytes(b'')
    else:
        start = len(content) // 8
        file.write_bytes(content[:start] + bytes(2 * start) + content[3 * start :])
    main_of = {'rescore': main, 'shadow': shadow.main}[command]
    with pytest.raises(SystemExit) as end:
        main_of([str(bag), *(['--checkpoint', 'none.pt'] if command == 'shadow' else [])])
    assert end.value.code == 2
    *_, line = capsys.readouterr().err.splitlines()
    assert line.startswith(f'{command}: error: bag {bag}: ')
    assert 'expected' in line
