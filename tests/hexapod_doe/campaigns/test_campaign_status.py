# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from hexapod_doe.campaign_status import main


def test_a_campaign_under_way(mixed, capsys):
    assert main([str(mixed.directory)]) == 1
    shown = capsys.readouterr().out
    assert '4 runs: 1 done, 1 running, 1 interrupted, 1 due' in shown
    assert '8/20 episodes' in shown
    *_, fourth, third, second, first, blank, label, last = shown.splitlines()
    assert (blank, label) == ('', 'next:')
    assert [line.split()[:3] for line in (fourth, third, second, first)] == [
        ['r4', 'AB', 'done'],
        ['r3', 'B', 'running'],
        ['r2', 'A', 'interrupted'],
        ['r1', 'none', 'due'],
    ]
    assert f'ros2 run hexapod_bringup watch {mixed.directory}' in last


def test_a_campaign_that_is_done(folder, capsys):
    for run_id in ('r1', 'r2', 'r3', 'r4'):
        folder.finish(run_id)
    assert main([str(folder.directory), '--quiet']) == 0
    assert capsys.readouterr().out == ''


def test_the_page_on_demand(mixed):
    main([str(mixed.directory), '--quiet', '--page'])
    assert '<title>1/4' in (mixed.directory / 'progress.html').read_text()


def test_a_folder_without_a_plan_is_one_line(tmp_path, capsys):
    assert main([str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert error.startswith('campaign_status: ')
    assert error.count('\n') == 1
    assert f'{tmp_path}: a folder without plan.csv' in error
    assert 'begins one' in error
    assert main([str(tmp_path / 'none')]) == 2
    assert 'no such folder' in capsys.readouterr().err


def test_a_folder_above_a_campaign_names_it(folder, capsys):
    (folder.directory / 'mine').mkdir()
    (folder.directory / 'plan.csv').rename(folder.directory / 'mine' / 'plan.csv')
    assert main([str(folder.directory)]) == 2
    assert f'such as {folder.directory}/mine' in capsys.readouterr().err


def test_a_campaign_that_nobody_works_at_says_so(folder, capsys):
    folder.finish('r4')
    main([str(folder.directory)])
    assert '3 due; nobody is at work' in capsys.readouterr().out
