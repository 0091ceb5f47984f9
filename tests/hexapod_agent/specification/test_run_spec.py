# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""article.yaml is complete, and a wrong file is refused by name, key and expectation."""

from dataclasses import fields
from importlib.resources import files

import pytest
import yaml
from hexapod_agent.specification.run_spec import ConfigError, RunSpec
from hexapod_agent.specification.spec_text import nest
from hexapod_sim.article import article_text
from hexapod_sim.sensor_table import LETTERS, SENSORS

from hexapod_sim import quality


@pytest.fixture
def write(tmp_path):
    def write(text: str):
        path = tmp_path / 'mine.yaml'
        path.write_text(text)
        return path

    return write


def leaves(mapping, prefix=''):
    for key, value in mapping.items():
        if isinstance(value, dict):
            yield from leaves(value, f'{prefix}{key}.')
        else:
            yield f'{prefix}{key}'


def test_article_names_every_value():
    """No value comes from a default in the code, where its origin would not be told."""
    expected = yaml.safe_load(article_text())
    expected['observations'] = dict.fromkeys(LETTERS, expected['observations']['each'])
    expected['sensors'] = dict.fromkeys(SENSORS, expected['sensors']['each'])
    assert set(leaves(expected)) == set(leaves(RunSpec.load().to_mapping()))


def test_every_value_of_the_article_has_an_origin():
    for line in article_text().splitlines():
        key, _, comment = line.partition('#')
        if key.strip() and not key.rstrip().endswith(':'):
            has_origin = any(mark in comment for mark in ('[article]', '[source]', '[ours]'))
            assert has_origin or line.startswith('    '), line


def test_sections():
    names = {field.name for field in fields(RunSpec)}
    assert names == {
        'observations',
        'quality',
        'sensors',
        'scene',
        'robot',
        'task',
        'cpg',
        'learner',
        'training',
    }


def test_every_value_of_a_grade_has_an_origin():
    text = (files('hexapod_sim') / 'sensor_quality.yaml').read_text(encoding='utf-8')
    for line in text.splitlines():
        key, _, comment = line.partition('#')
        if key.strip() and not key.rstrip().endswith(':'):
            assert any(mark in comment for mark in ('[sheet]', '[derived]', '[ours]')), line


@pytest.mark.parametrize('grade', quality.grades())
def test_a_grade_is_what_its_file_says(grade):
    spec = RunSpec.load(settings=[f'quality={grade}'])
    assert spec.sensors == quality.grades()[grade]
    assert any(not each.perfect for each in spec.sensors.values()) == (grade != 'perfect')
    assert RunSpec.from_text(spec.to_text(), 'a test') == spec
    assert spec.changed({'quality': 'perfect'}, 'a test') == RunSpec.load()


def test_what_is_said_of_a_sensor_goes_before_its_grade():
    settings = ['sensors.imu_data.noise=0.5', 'quality=consumer']
    spec = RunSpec.load().with_settings(settings)
    assert spec.sensors['imu_data'].noise == 0.5
    assert spec.sensors['imu_data'].bias == quality.grades()['consumer']['imu_data'].bias
    assert RunSpec.load().with_settings(settings[::-1]) == spec
    written = RunSpec.from_text('sensors: {imu_data: {noise: 0.5}}\nquality: consumer', 'a test')
    assert written == spec
    later = spec.with_settings(['quality=industrial'])
    assert later.sensors['imu_data'].noise == 0.5
    assert later.sensors['imu_data'].bias == quality.grades()['industrial']['imu_data'].bias


def test_industrial_devices_are_better_than_those_of_consumers():
    """In every figure that both have; a grade has no worse one than perfect."""
    consumer, industrial = (quality.grades()[grade] for grade in ('consumer', 'industrial'))
    for key in ('joint_states', 'joint_torques', 'imu_data_raw', 'body_height', 'foot_force'):
        for name, better in vars(industrial[key]).items():
            worse = getattr(consumer[key], name)
            assert not (better and worse) or better <= worse, (key, name)


def test_a_file_changes_what_it_names_and_nothing_else(write):
    config = RunSpec.load(write('learner: {ddpg: {discount: 0.98}}\ncpg: {hopf: {alpha: 30}}'))
    expected = RunSpec.load().to_mapping()
    expected['learner']['ddpg']['discount'] = 0.98
    expected['cpg']['hopf']['alpha'] = 30.0
    assert config.to_mapping() == expected


def test_mapping_round_trip():
    config = RunSpec.load()
    assert RunSpec.from_mapping(config.to_mapping(), 'a test') == config


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        (
            'ddgp: {}',
            "unknown key 'ddgp', expected one of observations, quality, sensors, scene, robot",
        ),
        (
            'learner: {ddpg: {gamma: 1}}',
            "unknown key 'learner.ddpg.gamma', expected one of b",
        ),
        ('cpg: {hopf: {speed: 1}}', "unknown key 'cpg.hopf.speed'"),
        ('learner: {ddpg: {batch_size: many}}', "ddpg.batch_size is 'many', expected"),
        (
            'learner: {ddpg: {update_every: 0}}',
            'learner.ddpg.update_every is 0, expected.*or equal to 1',
        ),
        (
            'learner: {ddpg: {update_ratio: 0}}',
            'learner.ddpg.update_ratio is 0, expected.*greater than 0',
        ),
        (
            'learner: {ddpg: {update_ratio: 0.3}}',
            r'update_ratio is 0.3, .*1/24: .* number .*, not 7.2',
        ),
        ('training: {episodes: 0}', 'training.episodes is 0, expected.*or equal to 1'),
        ('training: {window: -1}', 'training.window is -1, expected.*or equal to 1'),
        ('training: {checkpoint_every: 0}', 'training.checkpoint_every is 0, expected'),
        (
            'learner: {actor: {hidden: []}}',
            'learner.actor.hidden is .*, expected.*at least 1 item',
        ),
        ('learner: {actor: {hidden: [0]}}', 'actor.hidden.0 is 0, expected'),
        (
            'learner: {critic: {learning_rate: .nan}}',
            'learner.critic.learning_rate is nan, expected',
        ),
        ('learner: {noise: {sigma: .inf}}', 'noise.sigma is inf, expected'),
        (
            'learner: {ddpg: {discount: 1.5}}',
            'learner.ddpg.discount is 1.5, expected.*or equal to 1',
        ),
        ('training: {final_rate: -1}', 'training.final_rate is -1, expected.*greater than 0'),
        (
            'learner: {critic: {merge: multiply}}',
            "learner.critic.merge is 'multiply', expected.*'add' or 'append'",
        ),
        ('cpg: {hopf: {gait: gallop}}', 'gallop.*expected'),
        ('learner: {ddpg: 3}', 'ddpg is 3, expected keys'),
        ('- 1', 'expected sections with keys'),
        ('a: [', 'not YAML'),
        ('task: {line_y: 1}\ntask: {yaw_share: 0}', "key 'task' twice in one section"),
    ],
)
def test_wrong_files_are_refused(write, text, message):
    path = write(text)
    with pytest.raises(ConfigError, match=message) as caught:
        RunSpec.load(path)
    assert str(path) in str(caught.value)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(
        ConfigError, match=r'no.yaml.*not found, expected a YAML file with sections'
    ):
        RunSpec.load(tmp_path / 'no.yaml')


def test_the_home_folder_is_known(write, monkeypatch):
    path = write('learner: {ddpg: {discount: 0.5}}')
    monkeypatch.setenv('HOME', str(path.parent))
    assert RunSpec.load('~/mine.yaml').learner.ddpg.discount == 0.5


def test_differences_are_named_by_key(write):
    other = RunSpec.load(write('learner: {ddpg: {discount: 0.5}}\ncpg: {hopf: {alpha: 30.0}}'))
    assert RunSpec.load().differences(other) == {
        'learner.ddpg.discount': (0.99, 0.5),
        'cpg.hopf.alpha': (20.0, 30.0),
    }
    assert other.differences(other) == {}


def test_the_layout_before_there_was_a_learner_is_read():
    old = {'actor': {'hidden': [8]}, 'ddpg': {'discount': 0.5}, 'training': {'window': 3}}
    spec = RunSpec.from_mapping(old, 'an older bag')
    assert (spec.learner.actor.hidden, spec.learner.ddpg.discount) == ((8,), 0.5)
    assert spec.training.window == 3


@pytest.mark.parametrize(
    'key',
    [
        'learner.actor.layer_norm',
        'learner.critic.layer_norm',
        'learner.critic.twin',
        'learner.ddpg.normalize_observations',
    ],
)
def test_a_switch_that_is_gone_may_be_off_and_not_on(key):
    """Bags, plans and agents have these keys."""
    off = nest(key, False)
    assert RunSpec.from_mapping(off, 'an older bag') == RunSpec.load()
    assert RunSpec.from_mapping(off['learner'], 'an older layout') == RunSpec.load()
    assert RunSpec.load(None, [f'{key}=false']) == RunSpec.load()
    message = rf'^--set {key}=on: {key} is True, expected false or nothing: .*d8a52fe'
    with pytest.raises(ConfigError, match=message):
        RunSpec.load(None, [f'{key}=on'])


def test_text_round_trip():
    spec = RunSpec.load().observing('CE')
    assert RunSpec.from_text(spec.to_text(), 'a test') == spec


def test_observations_are_letters_or_switches():
    assert RunSpec.load().letters == ''
    assert RunSpec.from_text('observations: EBA', 'a test').letters == 'ABE'
    spec = RunSpec.from_text('observations: {C: on}', 'a test')
    assert (spec.letters, spec.observed.size) == ('C', 83)
    with pytest.raises(ConfigError, match=r"unknown key 'observations.X', expected one of A, B"):
        RunSpec.from_text('observations: {X: on}', 'a test')
    with pytest.raises(ValueError, match="unknown letter 'X'"):
        RunSpec.from_text('observations: AX', 'a test')


def test_the_quality_of_a_sensor_is_a_value_like_any_other():
    spec = RunSpec.load(None, ['sensors.imu_data.noise=0.05', 'sensors.body_height.rate=10'])
    assert (spec.value('sensors.imu_data.noise'), spec.sensors['body_height'].rate) == (0.05, 10.0)
    assert set(spec.differences(RunSpec.load())) == {
        'sensors.imu_data.noise',
        'sensors.body_height.rate',
    }
    assert RunSpec.from_text(spec.to_text(), 'a test') == spec
    assert quality.from_text(quality.to_text(spec.sensors)) == {
        key: found for key, found in spec.sensors.items() if not found.perfect
    }


def test_single_values_are_set_by_dotted_key():
    spec = RunSpec.load(None, ['task.closeness_weight=2', 'observations.C=on', 'cpg.reading=D2'])
    assert (spec.task.closeness_weight, spec.letters, spec.cpg.reading) == (2.0, 'C', 'D2')
    assert spec.value('learner.actor.learning_rate') == 1e-4
    assert spec.value('critic.merge') == 'add'  # as keys were before


def test_values_that_go_together_may_be_set_in_any_order():
    settings = ['learner.ddpg.update_ratio=0.2', 'learner.ddpg.update_every=5']
    assert RunSpec.load(None, settings) == RunSpec.load(None, reversed(settings))
    with pytest.raises(ConfigError, match=r'--set .*=7 --set .*=0.2: .* a multiple of 1/7'):
        RunSpec.load(None, ['learner.ddpg.update_every=7', settings[0]])


@pytest.mark.parametrize(
    ('setting', 'message'),
    [
        ('task.closeness_weight', 'expected key=value'),
        ('=3', 'expected key=value'),
        ('task.nearness=1', "--set task.nearness=1: unknown key 'task.nearness'"),
        ('task=1', 'task is 1, expected keys'),
        ('sensors.imu.noise=1', "unknown key 'sensors.imu', expected one of joint_states, line_o"),
        ('sensors.imu_data.noise=-1', 'sensors.imu_data.noise is -1, expected.*or equal to 0'),
        ('sensors.imu_data.dropout=1', 'sensors.imu_data.dropout is 1, expected.*equal to 0.999'),
        ('sensors.foot_contacts.bias=1', 'sensors.foot_contacts.bias is 1.0, expected at most 0'),
        ('sensors.imu_data.quantisation=1', 'is 1.0, expected at most 0.5 for body orientation'),
        ('observations.C=maybe', "observations.C is 'maybe', expected"),
        ('learner.algorithm=ppq', "learner.algorithm is 'ppq', expected"),
        ('task.line_y=[', 'not YAML'),
    ],
)
def test_settings_that_do_not_fit_are_refused(setting, message):
    with pytest.raises(ConfigError, match=message):
        RunSpec.load(None, [setting])
