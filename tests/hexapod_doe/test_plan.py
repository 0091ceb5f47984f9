# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The command line makes, extends and explains plans."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from hexapod_doe.designs.plan_file import read_plan
from hexapod_doe.plan import main

import hexapod_agent

ROOT = Path(__file__).parents[2]
DATA = ROOT / 'tests' / 'data' / 'doe_cases'
SAMPLE = str(ROOT / 'bags' / 'sample_campaign')


@pytest.fixture
def quarter(tmp_path):
    """A plan file of the quarter fraction with two replicates."""
    main(['--design', 'quarter', '--replicates', '2', '--out', str(tmp_path / 'plan.csv')])
    return tmp_path / 'plan.csv'


def test_a_plan_is_made_as_a_module_without_a_command_name(tmp_path):
    out = tmp_path / 'plan.csv'
    command = [sys.executable, '-m', 'hexapod_doe.plan', '--design', 'eighth']
    command += ['--replicates', '1', '--seed', '1', '--out', str(out)]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    assert 'I = ABCE = ABFG = ACDG = ADEF = BCDF = BDEG = CEFG, resolution IV' in result.stdout
    assert 'AB + CE + FG' in result.stdout
    assert len(read_plan(out).rows) == 16


@pytest.mark.parametrize('case', ['alias_2_7_2', 'alias_2_7_3'])
def test_the_words_and_the_alias_table_of_a_design(case, capsys):
    expected = json.loads((DATA / f'{case}.json').read_text())
    generators = ','.join(f'{factor}={word}' for factor, word in expected['generators'].items())
    main(['aliases', '--generators', generators, '--max-order', '3'])
    cases, words, pattern, *table = capsys.readouterr().out.splitlines()
    assert cases == f'{expected["runs"]} cases'
    assert words == f'{expected["defining_relation"]}, resolution IV'
    counts = expected['word_length_pattern'].items()
    assert pattern == f'Words by length: {", ".join(f"{k} = {n}" for k, n in counts)}'
    assert table == [' + '.join(group) for group in expected['alias_table_up_to_3fi']]


def test_the_alias_table_of_a_plan_and_its_follow_up(quarter, capsys):
    out = quarter.with_name('more.csv')
    main(['fold', str(quarter), '--on', 'C', '--out', str(out)])
    capsys.readouterr()
    main(['aliases', '--plan', str(quarter), str(out)])
    cases, words, _, *table = capsys.readouterr().out.splitlines()
    # Folding on C cancels the words that hold it, CEFG and ABCDF.
    assert (cases, words) == ('64 cases', 'I = ABDEG, resolution V')
    assert len(table) == 7 + 21


def test_generators_and_signs_choose_the_fraction(tmp_path, capsys):
    main(['make', '--generators', 'D=-ABC', '--factors', '4', '--out', str(tmp_path / 'p.csv')])
    assert 'I = -ABCD' in capsys.readouterr().out
    assert len(read_plan(tmp_path / 'p.csv').levels) == 8


def test_blocks_say_what_they_hide(tmp_path, capsys):
    main(['--design', 'quarter', '--blocks', 'ACE', '--out', str(tmp_path / 'p.csv')])
    assert 'Blocks hide: ACE + AFG' in capsys.readouterr().out


def test_a_semifold_separates_the_pairs(quarter, capsys):
    out = quarter.with_name('more.csv')
    main(['fold', str(quarter), '--on', 'C', '--keep', 'A+', '--out', str(out)])
    assert 'All terms to order 2 separate.' in capsys.readouterr().out
    further = read_plan(out)
    assert (len(further.levels), len(further.rows)) == (16, 32)
    assert further.settings.follows == 'semifold on C, cases with A+'


def test_a_full_foldover_says_that_it_does_not(quarter, capsys):
    main(['fold', str(quarter), '--on', 'ABCDEFG', '--out', str(quarter.with_name('more.csv'))])
    assert 'Cannot separate: CE + FG; CF + EG; CG + EF' in capsys.readouterr().out


def test_eight_cases_separate_the_pairs(quarter, capsys):
    out = quarter.with_name('more.csv')
    main(['augment', str(quarter), '--extra', '8', '--replicates', '1', '--out', str(out)])
    text = capsys.readouterr().out
    assert 'All terms to order 2 separate.' in text
    assert text.count('variance 1.25 times') == 6
    assert len(read_plan(out).rows) == 8


def test_augmentation_aims_at_named_terms(quarter, capsys):
    out = quarter.with_name('more.csv')
    main(['augment', str(quarter), '--extra', '2', '--separate', 'CE,FG', '--out', str(out)])
    assert 'FG: variance' in capsys.readouterr().out
    with pytest.raises(SystemExit):
        main(['augment', str(quarter), '--extra', '2', '--out', str(out)])
    assert 'not enough to estimate' in capsys.readouterr().err


def test_power_is_told_with_and_without_failures(capsys):
    options = ['--replicates', '10', '--sigma', '40', '--effect', '60', '--loss', '400']
    main(['power', '--design', 'quarter', *options, '--failure', '0.2', '--repeats', '200'])
    text = capsys.readouterr().out
    # The reference table: 320 runs, 26 parameters find 0.31425 sigma.
    assert f'{0.3142541619790811 * 40:.4g}' in text
    assert '1.0000 if no run fails' in text
    assert 'Power with 20 % failing runs: 0.7' in text


def test_hours_become_a_proposal(capsys):
    options = ['--hours', '25', '--seconds-per-run', '10', '--run-episodes', '4']
    main(['hours', *options, '--workers', '2'])
    text = capsys.readouterr().out
    assert '\nProposed:\nquarter: 32 cases x 2 replicates x 1000 episodes' in text
    assert text.count('Instead:') == 3


def test_hours_take_a_configuration_factors_and_what_finished_runs_took(tmp_path, capsys):
    swift = str(Path(hexapod_agent.__file__).with_name('swift.yaml'))
    budget = ['hours', '--hours', '4', '--workers', '2']
    main([*budget, '--config', swift])
    text = capsys.readouterr().out
    assert text.startswith('A run of 140 episodes: 70.5 s of a core, judged by two cores')
    assert 'quarter: 32 cases x 10 replicates x 140 episodes = 3.1 h' in text
    main(
        [
            *budget,
            '--config',
            swift,
            '--factors',
            str(ROOT / 'docs' / 'factors.yaml'),
            '--measured',
            SAMPLE,
        ]
    )
    text = capsys.readouterr().out
    assert re.search(
        r'^A run of 140 .* by 8 runs of .*sample_campaign, [\d.]+ per core-hour', text
    )
    with pytest.raises(SystemExit, match='2'):
        main([*budget, '--set', 'learner.ddpg.batch_size=256'])
    assert 'expected --measured or --seconds-per-run' in capsys.readouterr().err
    (tmp_path / 'plan.csv').write_text(Path(SAMPLE, 'plan.csv').read_text())
    with pytest.raises(SystemExit, match='2'):
        main([*budget, '--measured', str(tmp_path)])
    assert 'no finished run, expected some' in capsys.readouterr().err


def test_the_measured_run_is_a_whole_training_unless_told(capsys):
    budget = ['hours', '--hours', '48', '--seconds-per-run', '1200']
    main(budget)
    # 48 h are 144 trainings of 20 min: 128 are two of each case of a half.
    text = capsys.readouterr().out
    assert text.startswith('A run of 1000 episodes: 1.2e+03 s of a core, as given.\nProposed:\n')
    assert 'Proposed:\nhalf: 64 cases x 2 replicates x 1000 episodes = 42.7 h' in text
    main([*budget, '--run-episodes', '1000'])
    assert capsys.readouterr().out == text


@pytest.mark.parametrize(
    ('words', 'message'),
    [
        (['--generators', 'F=ABX'], "plan: generator F=ABX: 'X' is not a base factor"),
        (['--factors', '16'], 'plan: 16 factors: expected 2 to 15'),
        (['fold', '/nowhere/plan.csv', '--on', 'C'], 'plan: /nowhere/plan.csv: no such file'),
        (['power', '--design', 'eighth', '--max-order', '3'], 'plan: 16 runs, 16 parameters'),
        (['hours', '--hours', '0.0001', '--seconds-per-run', '60'], 'plan: 0.0001 h pay for'),
    ],
)
def test_errors_are_one_line(words, message, capsys):
    with pytest.raises(SystemExit, match='2'):
        main(words)
    error = capsys.readouterr().err
    assert re.match(message, error)
    assert error.count('\n') == 1


def test_an_unknown_design_is_named(capsys):
    with pytest.raises(SystemExit):
        main(['--design', 'third'])
    assert "design 'third': expected one of full, half" in capsys.readouterr().err
