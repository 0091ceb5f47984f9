# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Runs are told apart by what decides their results, and by nothing else."""

import pytest
import yaml
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_doe.bags.run_identity import differences, making, odd_runs, run_identity, settings


def text(**changes: object) -> str:
    """Return the configuration of a run as its bag holds it."""
    config = RunSpec.from_mapping(changes, 'test')
    return yaml.safe_dump(config.to_mapping(), sort_keys=False)


RUN = {'observations': 'AC', 'seed': '7', 'episodes': '5', 'evaluation': '20'}


def run(**changes: str) -> dict[str, str]:
    return run_identity(RUN | changes)


@pytest.mark.parametrize(
    ('changes', 'told'),
    [
        ({}, ''),
        ({'observations': 'CA'}, ''),
        ({'observations': ''}, 'observations none, expected AC'),
        ({'seed': '8'}, 'seed 8, expected 7'),
        ({'episodes': '6'}, 'episodes 6, expected 5'),
        ({'evaluation': '10'}, 'evaluation 10, expected 20'),
        ({'worker': '/w2'}, ''),
    ],
)
def test_a_run_is_its_sensors_seed_and_length(changes, told):
    assert differences(run(**changes), run()) == told


def test_every_value_of_the_configuration_counts():
    found = differences(
        run(config=text(actor={'hidden': [8, 8]})), run(config=text(actor={'hidden': [16, 8]}))
    )
    assert found == 'config.learner.actor.hidden [8, 8], expected [16, 8]'


@pytest.mark.parametrize('key', ['episodes', 'checkpoint_every'])
def test_what_changes_no_result_does_not(key):
    assert settings({'config': text(training={key: 3})}) == settings({'config': text()})


def test_an_older_configuration_is_filled_up_and_a_strange_one_is_another():
    older = yaml.safe_load(text())
    del older['learner']['noise']
    assert settings({'config': yaml.safe_dump(older)}) == settings({'config': text()})
    for strange in ('x', 'sails: 3', '{'):
        assert differences(run(config=strange), run(config=text()))


def test_what_a_bag_does_not_state_is_not_held_against_it():
    assert differences({}, run(config=text())) == ''
    before = {key: value for key, value in run().items() if key != 'evaluation'}
    assert differences(before, run()) == ''


def test_the_odd_ones_are_named_and_the_others_counted():
    runs = {f'r{n}': run(episodes='1' if n < 2 else '6') for n in range(16)}
    assert odd_runs(runs) == {'episodes': 'episodes 1 in r0, r1; 6 in the other 14'}
    assert odd_runs(runs, without=['episodes']) == {}


def test_blocks_by_configuration_cover_all_of_it():
    runs = {
        'a': settings({'config': text(actor={'hidden': [8]})}),
        'b': settings({'config': text()}),
    }
    assert list(odd_runs(runs)) == ['config.learner.actor.hidden']
    assert odd_runs(runs, without=['config']) == {}


def test_sections_of_a_learner_are_compared_where_both_algorithms_have_them():
    def learned(algorithm: str, **section: object) -> dict[str, str]:
        return run(config=text(learner={'algorithm': algorithm, **section}))

    ddpg, td3 = learned('ddpg'), learned('td3')
    algorithm = 'config.learner.algorithm'
    assert differences(td3, ddpg) == f'{algorithm} td3, expected ddpg'
    assert list(odd_runs({'a': td3, 'b': ddpg, 'c': learned('ppo')})) == [algorithm]
    louder = learned('td3', noise={'sigma': 0.7}, td3={'policy_delay': 3})
    assert list(odd_runs({'a': louder, 'b': ddpg}, without=[algorithm])) == [
        'config.learner.noise.sigma'
    ]
    assert 'config.learner.td3.policy_delay 3, expected 2' in differences(louder, td3)


def test_versions_are_what_a_run_was_made_with():
    assert making({'version.numpy': '2.4.6', 'machine': 'x86_64', 'seed': '3'}) == {
        'version.numpy': '2.4.6',
        'machine': 'x86_64',
    }
