# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Commands that take long say what they are at, and quick ones keep to their result."""

import time
from pathlib import Path

import pytest
from hexapod_doe.stages import stage

from hexapod_doe import analyze, stages

GOOD = Path(__file__).resolve().parents[1] / 'data/cases/good.csv'


def test_a_long_stage_is_told_once(capsys) -> None:
    with stage('fitting', patience_s=0.01):
        time.sleep(0.2)
    assert capsys.readouterr().err == 'fitting ...\n'


def test_a_quick_stage_and_one_that_fails_say_nothing(capsys) -> None:
    with pytest.raises(ValueError), stage('reading', patience_s=0.2):  # noqa: PT011
        raise ValueError
    time.sleep(0.3)
    assert capsys.readouterr().err == ''


def test_analyze_tells_its_stages(capsys, monkeypatch, tmp_path) -> None:
    told: list[str] = []
    monkeypatch.setattr(stages.threading, 'Timer', lambda _, tell, args: _Timer(tell, args))
    monkeypatch.setattr(stages, '_tell', told.append)
    monkeypatch.setattr(analyze, 'write_report', lambda analysis, out: out / 'index.html')
    assert analyze.main(['--table', str(GOOD), '--response', 'y', '--out', str(tmp_path)]) == 0
    assert len(told) == 3
    assert all(text.startswith('analyze: ') for text in told)


class _Timer:
    """A timer whose time is up at once."""

    def __init__(self, tell, args) -> None:
        self.start = lambda: tell(*args)
        self.cancel = lambda: None
