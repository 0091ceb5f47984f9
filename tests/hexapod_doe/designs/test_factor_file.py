# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A factor is any key of a run's specification; a file that cannot be run gives its one line."""

import io
import json
from pathlib import Path

import pytest
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.campaigns.overview import overview
from hexapod_doe.campaigns.page import render
from hexapod_doe.campaigns.row import read_rows
from hexapod_doe.designs.plan_file import PlanError, read_plan
from rich.console import Console

from hexapod_doe import plan
from hexapod_sim import quality

GOOD = """
- {name: body orientation, key: observations.C, low: off, high: on, device: IMU}
- {name: body height, key: observations.E, low: off, high: on}
- {name: yaw share, key: task.yaw_share, low: 0, high: 1}
- {name: learning rate, key: learner.actor.learning_rate, low: 1e-4, high: 2.0e-4}
"""

HARDER = """
- {name: ground, key: scene.name, low: flat, high: rough}
- {name: payload, key: robot.payload, low: 0, high: 1.2}
- {name: body orientation, key: observations.C, low: off, high: on}
- {name: dead legs, key: robot.dead_legs, low: none, high: lm+rf}
- {name: devices, key: quality, low: perfect, high: consumer}
"""


def written(tmp_path, text, *options):
    """Run `plan` on a factor file and return where its plan would be."""
    file = tmp_path / 'mine.yaml'
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    out = tmp_path / 'new' / 'plan.csv'
    plan.main(['--factors', str(file), '--design', 'half', '--out', str(out), *options])
    return out


def test_a_row_is_the_base_with_its_levels(tmp_path):
    out = written(tmp_path, GOOD, '--set', 'task.closeness_weight=3')
    rows = read_rows(out)
    assert len(rows) == 8
    for row in rows:
        level = {name: int(row.metadata[name]) > 0 for name in 'CEAB'}  # sensors keep theirs
        changes = {
            'observations': {'C': level['C'], 'E': level['E']},
            'task': {'closeness_weight': 3.0, 'yaw_share': float(level['A'])},
            'learner': {'actor': {'learning_rate': 2e-4 if level['B'] else 1e-4}},
        }
        assert row.spec == RunSpec.from_mapping(changes, 'test')
        assert row.observations == row.spec.letters


def test_a_plan_keeps_factors_and_base(tmp_path):
    out = written(tmp_path, GOOD, '--set', 'task.closeness_weight=3')
    kept = json.loads(out.with_suffix('.json').read_text())
    assert kept['factors'][0] == {
        'letter': 'C', 'name': 'body orientation', 'key': 'observations.C',
        'low': False, 'high': True, 'device': 'IMU',
    }  # fmt: skip
    assert kept['factors'][3]['low'] == 1e-4
    assert kept['base']['task']['closeness_weight'] == 3.0
    read = read_plan(out)
    assert read.factors == 'CEAB'
    assert read.treatments.factors[2].change == 'yaw share 0 → 1'
    assert read.treatments.factors[0].change == 'body orientation off → on'


def test_what_follows_a_plan_has_its_factors(tmp_path):
    out = written(tmp_path, GOOD)
    folded, confirm = tmp_path / 'b' / 'plan.csv', tmp_path / 'c' / 'plan.csv'
    plan.main(['fold', str(out), '--on', 'A', '--out', str(folded)])
    plan.main(['confirm', str(out), '--sets', 'CA,none', '--out', str(confirm)])
    for path in (folded, confirm):
        assert read_plan(path).treatments == read_plan(out).treatments
        assert read_plan(path).settings.predecessor == read_plan(out).fingerprint
    assert read_rows(confirm)[0].spec.task.yaw_share == 1.0


def test_sixteen_rows_hold_eight_factors_and_fifteen(tmp_path):
    for count, resolution in ((8, 4), (15, 3)):
        out = tmp_path / f'{count}.csv'
        generated = ['--design', 'sixteenth'] if count == 8 else ['--generators', FIFTEEN]
        plan.main(['--factors', str(count), *generated, '--out', str(out)])
        read = read_plan(out)
        assert (len(read.rows), len(read.factors)) == (16, count)
        assert read.settings.resolution == resolution


FIFTEEN = 'E=ABC,F=ABD,G=ACD,H=BCD,J=ABCD,K=AB,L=AC,M=AD,N=BC,O=BD,P=CD'  # all words of ABCD
OTHER = '\n- {name: b, key: task.height_weight, low: 0, high: 1}'


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('', 'no list, expected a list of 2 to 15 factors'),
        ('[]', '0 factors, expected a list of 2 to 15 factors'),
        ('a: [', 'not YAML'),
        (b'- \xff', 'not YAML'),
        ('- 3' + OTHER, 'factor 1 is 3, expected name, key, low, high'),
        ('- {name: a, key: task.line_y, low: 0}' + OTHER, "factor 'a': no high, expected name"),
        (
            '- {name: a, key: task.yaw, low: 0, high: 1}' + OTHER,
            "factor 'a': unknown key 'task.yaw', expected one of task.time_limit_steps, ",
        ),
        (
            '- {name: a, key: task, low: 0, high: 1}' + OTHER,
            "factor 'a': key 'task' is a section, expected one of task.time_limit_steps, ",
        ),
        (
            '- {name: a, key: task.yaw_share, low: 0, high: fast}' + OTHER,
            "factor 'a': high level: task.yaw_share is 'fast', expected",
        ),
        (
            '- {name: a, key: task.yaw_share, low: 0, high: true}' + OTHER,
            "factor 'a': high level: task.yaw_share is True, expected a value such as 1.0",
        ),
        (
            '- {name: a, key: training.precision, low: float32, high: auto}' + OTHER,
            "factor 'a': high level: training.precision is 'auto', which becomes what the",
        ),
        (
            '- {name: a, key: observations.A, low: 0, high: 1}' + OTHER,
            "factor 'a': low level: observations.A is 0, expected true or false",
        ),
        (
            '- {name: a, key: learner.ddpg.discount, low: 0.9, high: 1.5}' + OTHER,
            "factor 'a': high level: learner.ddpg.discount is 1.5, expected",
        ),
        (
            '- {name: a, key: learner.ddpg.discount, low: 0.9, high: .nan}' + OTHER,
            "factor 'a': high level: learner.ddpg.discount is nan, expected",
        ),
        (
            '- {name: a, key: task.yaw_share, low: 1, high: 1.0}' + OTHER,
            "factor 'a': low and high level of task.yaw_share are both 1.0, expected two values",
        ),
        (
            '- {name: a, key: task.height_weight, low: 1, high: 2}' + OTHER,
            "factor 'b': key task.height_weight is also that of factor 'a', expected another",
        ),
        (
            '- {name: b, key: task.yaw_share, low: 1, high: 2}' + OTHER,
            "factor 'b': name b is also that of factor 'b', expected another",
        ),
        (
            '- {name: a, letter: AB, key: task.yaw_share, low: 1, high: 2}' + OTHER,
            "factor 'a': letter 'AB', expected one of ABCDEFGHJKLMNOP",
        ),
        (
            '- {name: a, price: 3, key: task.yaw_share, low: 1, high: 2}' + OTHER,
            "factor 'a': unknown entry 'price', expected name, key, low, high, device, letter",
        ),
        (
            '- {name: a, key: training.episodes, low: 10, high: 20}' + OTHER,
            "factor 'a': key training.episodes is the same for all runs of a campaign",
        ),
        (
            '- {name: a, key: sensors.foot_contacts.noise, low: 0, high: 7}\n'
            '- {name: c, key: task.yaw_share, low: 0, high: 1}' + OTHER,
            "factor 'a': sensors.foot_contacts.noise is 7.0, expected at most",
        ),
        (
            '- {name: a, key: sensors.compass.noise, low: 0, high: 1}' + OTHER,
            "factor 'a': unknown key 'sensors.compass.noise', expected one of sensors.",
        ),
        (  # each level alone goes with the base, two of them not with one another
            '- {name: a, key: learner.ddpg.update_every, low: 10, high: 20}\n'
            '- {name: b, key: learner.ddpg.update_ratio, low: 0.5, high: 0.05}'
            '\n- {name: c, key: task.yaw_share, low: 0, high: 1}',
            'B b 0.05, C c 0: learner.ddpg.update_ratio is 0.05, expected a multiple of 1/10',
        ),
        (  # runs that would be refused when they begin
            '- {name: a, key: task.time_limit_steps, low: 20, high: 30}'
            + OTHER
            + '\n- {name: c, key: task.yaw_share, low: 0, high: 1}',
            'learner.ddpg.update_every is 24, expected at most',
        ),
        (
            '- {name: a, key: learner.ddpg.buffer_size, low: 128, high: 9000}'
            + OTHER
            + '\n- {name: c, key: task.yaw_share, low: 0, high: 1}',
            'learner.ddpg.buffer_size is 128, expected more than',
        ),
        (
            '- {name: a, name: c, key: task.yaw_share, low: 0, high: 1}' + OTHER,
            "not YAML: key 'name' twice in one section",
        ),
    ],
)
def test_a_malformed_file_gives_one_line_and_no_plan(tmp_path, capsys, text, message):
    with pytest.raises(SystemExit) as ended:
        written(tmp_path, text)
    assert ended.value.code == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count('\n') == 1
    assert not (tmp_path / 'new').exists()


@pytest.mark.parametrize(('options', 'told'), [((), True), (('--set', 'observations=F'), False)])
def test_a_sensor_that_no_case_observes_is_told(tmp_path, capsys, options, told):
    noise = '- {name: n, key: sensors.foot_force.noise, low: 0, high: 1}\n'
    always = '- {name: j, key: sensors.joint_states.noise, low: 0, high: 0.1}'
    written(tmp_path, noise + always + OTHER, *options)
    note = "Note: 'n' changes nothing: no case observes foot forces (observations.F)\n"
    printed = capsys.readouterr().out
    assert (note in printed, printed.count('Note')) == (told, int(told))


def test_a_plan_without_its_factors_is_refused_and_they_are_named(tmp_path):
    sensor = '- {name: a, key: task.yaw_share, low: 0, high: 1}\n'
    out = written(
        tmp_path, sensor + '- {name: s, key: observations.F, low: off, high: on}' + OTHER
    )
    out.with_suffix('.json').unlink()
    with pytest.raises(PlanError, match=r'by the factor columns; plan.json, which names other'):
        read_plan(out)


def test_the_example_plans_eight_factors_in_sixteen_rows(tmp_path, capsys):
    example = Path(__file__).resolve().parents[3] / 'docs' / 'factors.yaml'
    out = tmp_path / 'plan.csv'
    plan.main(['--factors', str(example), '--design', 'sixteenth', '--out', str(out)])
    printed = capsys.readouterr().out
    assert 'C  body orientation off → on  (observations.C)' in printed
    assert 'G  IMU noise 0 → 0.05  (sensors.imu_data.noise)' in printed
    assert 'resolution IV' in printed
    rows = read_rows(out)
    assert len({row.spec.to_text() for row in rows}) == len(rows) == 16
    assert {row.spec.sensors['imu_data'].noise for row in rows} == {0.0, 0.05}


def test_grounds_robots_and_grades_of_sensors_are_factors(tmp_path, capsys):
    out = written(tmp_path, HARDER, '--set', 'scene.roughness=0.03')
    assert 'A  ground flat → rough  (scene.name)' in capsys.readouterr().out
    for row in read_rows(out):
        high = {name: int(row.metadata[name]) > 0 for name in 'ABD'}
        spec = row.spec
        assert (spec.scene.name, spec.scene.roughness) == (
            ('rough' if high['A'] else 'flat'),
            0.03,
        )
        assert spec.robot.payload == (1.2 if high['B'] else 0.0)
        assert spec.robot.dead_legs == ('lm+rf' if high['D'] else 'none')
        assert spec.sensors == quality.grades()[spec.quality]
    assert {row.spec.quality for row in read_rows(out)} == {'perfect', 'consumer'}


def test_progress_names_factors_and_levels(tmp_path):
    out = written(tmp_path, GOOD)
    progress = read_progress(out.parent)
    page = render(progress)
    assert 'yaw share 0 → 1' in page
    assert 'sensors' not in page
    console = Console(file=io.StringIO(), width=120)
    console.print(overview(progress, progress.runs.values()))
    assert 'C  body orientation off → on' in console.file.getvalue()
    assert {run.label for run in progress.runs.values()} >= {'none', 'CEAB'}
    text = next(row.text for row in read_rows(out) if row.label == 'CE')
    assert text == 'body orientation on, body height on, yaw share 0, learning rate 0.0001'


def test_a_file_named_like_a_number_or_letters_is_no_factor_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ('7', 'ABC'):
        (tmp_path / name).write_text('no factors')
    for factors, count in (
        (['--design', 'quarter'], 7),
        (['--factors', 'ABC', '--design=full'], 3),
    ):
        plan.main([*factors, '--out', f'{count}.csv'])
        assert len(read_plan(tmp_path / f'{count}.csv').factors) == count
