# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""article.yaml is complete, and a wrong file is refused by name, key and expectation."""

from dataclasses import fields

import pytest
import yaml
from hexapod_agent.config import AgentConfig, ConfigError
from hexapod_sim.article import article_text


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
    config = AgentConfig.load()
    assert set(leaves(yaml.safe_load(article_text()))) == set(leaves(config.to_mapping()))


def test_every_value_of_the_article_has_an_origin():
    for line in article_text().splitlines():
        key, _, comment = line.partition('#')
        if key.strip() and not key.rstrip().endswith(':'):
            has_origin = any(mark in comment for mark in ('[article]', '[source]', '[ours]'))
            assert has_origin or line.startswith('    '), line


def test_sections():
    names = {field.name for field in fields(AgentConfig)}
    assert names == {'task', 'cpg', 'actor', 'critic', 'ddpg', 'noise', 'training'}


def test_a_file_changes_what_it_names_and_nothing_else(write):
    config = AgentConfig.load(write('ddpg: {discount: 0.98}\ncpg: {hopf: {alpha: 30}}'))
    expected = AgentConfig.load().to_mapping()
    expected['ddpg']['discount'] = 0.98
    expected['cpg']['hopf']['alpha'] = 30.0
    assert config.to_mapping() == expected


def test_mapping_round_trip():
    config = AgentConfig.load()
    assert AgentConfig.from_mapping(config.to_mapping(), 'a test') == config


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('ddgp: {}', "unknown key 'ddgp', expected one of task, cpg"),
        ('ddpg: {gamma: 1}', "unknown key 'ddpg.gamma', expected one of batch_size"),
        ('cpg: {hopf: {speed: 1}}', "unknown key 'cpg.hopf.speed'"),
        ('ddpg: {batch_size: many}', "ddpg.batch_size is 'many', expected"),
        ('ddpg: {update_every: 0}', 'ddpg.update_every is 0, expected.*or equal to 1'),
        ('ddpg: {update_ratio: 0}', 'ddpg.update_ratio is 0, expected.*greater than 0'),
        ('ddpg: {update_ratio: 0.3}', r'update_ratio is 0.3, .*1/24: .* number .*, not 7.2'),
        ('training: {episodes: 0}', 'training.episodes is 0, expected.*or equal to 1'),
        ('training: {window: -1}', 'training.window is -1, expected.*or equal to 1'),
        ('training: {checkpoint_every: 0}', 'training.checkpoint_every is 0, expected'),
        ('actor: {hidden: []}', 'actor.hidden is .*, expected.*at least 1 item'),
        ('actor: {hidden: [0]}', 'actor.hidden.0 is 0, expected'),
        ('critic: {learning_rate: .nan}', 'critic.learning_rate is nan, expected'),
        ('noise: {sigma: .inf}', 'noise.sigma is inf, expected'),
        ('ddpg: {discount: 1.5}', 'ddpg.discount is 1.5, expected.*or equal to 1'),
        ('training: {final_rate: -1}', 'training.final_rate is -1, expected.*or equal to 0'),
        ('critic: {merge: multiply}', "critic.merge is 'multiply', expected.*'add' or 'append'"),
        ('cpg: {hopf: {gait: gallop}}', 'gallop.*expected'),
        ('ddpg: 3', 'ddpg. is 3, expected keys'),
        ('- 1', 'expected sections with keys'),
        ('a: [', 'not YAML'),
    ],
)
def test_wrong_files_are_refused(write, text, message):
    path = write(text)
    with pytest.raises(ConfigError, match=message) as caught:
        AgentConfig.load(path)
    assert str(path) in str(caught.value)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(
        ConfigError, match=r'no.yaml.*not found, expected a YAML file with sections'
    ):
        AgentConfig.load(tmp_path / 'no.yaml')


def test_the_home_folder_is_known(write, monkeypatch):
    path = write('ddpg: {discount: 0.5}')
    monkeypatch.setenv('HOME', str(path.parent))
    assert AgentConfig.load('~/mine.yaml').ddpg.discount == 0.5


def test_differences_are_named_by_key(write):
    other = AgentConfig.load(write('ddpg: {discount: 0.5}\ncpg: {hopf: {alpha: 30.0}}'))
    assert AgentConfig.load().differences(other) == {
        'ddpg.discount': (0.99, 0.5),
        'cpg.hopf.alpha': (20.0, 30.0),
    }
    assert other.differences(other) == {}
