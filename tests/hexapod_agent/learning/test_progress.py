# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A training into a pipe tells of itself in lines."""

from types import SimpleNamespace

from hexapod_agent.learning import progress
from hexapod_agent.learning.progress import episode_report


def summary(episode: int) -> SimpleNamespace:
    return SimpleNamespace(
        episode=episode,
        episode_return=100.0 + episode,
        average_return=50.0,
        metrics={'saturated_share': 0.25},
    )


def test_first_last_and_one_each_half_minute(monkeypatch, capsys) -> None:
    # Ten episodes of 10 s each: told are the first and those 30, 60 and 90 s later.
    now = [0.0]
    monkeypatch.setattr(progress.time, 'monotonic', lambda: now[0])
    with episode_report('CE', 0, 10) as report:
        for episode in range(10):
            now[0] = 1.0 + 10.0 * episode
            report(summary(episode))
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == 'CE: episode 1 of 10, return 100, mean 50, saturated 25%'
    assert [int(line.split()[2]) for line in lines] == [1, 4, 7, 10]


def test_an_evaluation_is_told_as_one(monkeypatch, capsys) -> None:
    monkeypatch.setattr(progress.time, 'monotonic', lambda: 1.0)
    with episode_report('CE', 0, 10) as report:
        for start in range(3):
            report(summary(start), 3)
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(', ')[:2] for line in lines] == [
        ['CE: evaluating', f'start {number} of 3'] for number in (1, 3)
    ]


def test_a_terminal_gets_a_bar(monkeypatch, capsys) -> None:
    monkeypatch.setenv('FORCE_COLOR', '1')
    monkeypatch.setenv('TERM', 'xterm')
    with episode_report('CE', 2, 4) as report:
        report(summary(2))
    output = capsys.readouterr().out
    assert '3/4' in output
    assert 'episode 3' not in output
