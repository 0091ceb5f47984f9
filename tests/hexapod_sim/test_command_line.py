# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Options out of range are one line with status 2, `~` is the home, no terminal is too narrow."""

import io
import os
import subprocess
import sys
from argparse import ArgumentTypeError
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import pytest
from annotated_types import Interval
from hexapod_sim.command_line import (
    CommandLine,
    Option,
    add_options,
    file,
    folder,
    number,
    one_line,
    options_of,
    path,
    range_fault,
    whole,
)
from hypothesis import given
from hypothesis import strategies as st

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True)
class Settings:
    share: Annotated[float, Interval(gt=0, lt=1), Option('a share')] = 0.5
    count: Annotated[int | None, Interval(ge=1), Option('a count', metavar='N')] = None
    quick: Annotated[bool, Option('be quick')] = False
    checked: Annotated[bool, Option('check')] = True
    kept: int = 3


def parser() -> CommandLine:
    made = CommandLine(prog='it')
    add_options(made, Settings, ('share', 'count', 'quick', 'checked'))
    return made


def test_a_dataclass_declares_the_options() -> None:
    given = options_of(Settings, parser().parse_args(['--share', '0.1', '--no-checked']))
    assert Settings(**given) == Settings(share=0.1, checked=False)
    assert options_of(Settings, parser().parse_args([])) == {
        'share': 0.5, 'count': None, 'quick': False, 'checked': True,
    }  # fmt: skip


def test_the_ranges_hold_for_callers_too() -> None:
    assert range_fault(Settings()) == ''
    assert range_fault(Settings(count=0)) == 'count 0: expected at least 1, a whole number'
    assert range_fault(Settings(share=float('nan'))).startswith('share nan: expected a number')


@pytest.mark.parametrize(
    ('words', 'message'),
    [
        (['--share', '95'], 'expected a number above 0 and below 1: 95 % is 0.95'),
        (['--share', 'nan'], "'nan', expected a number above 0 and below 1"),
        (['--share', 'half'], "'half', expected a number above 0 and below 1"),
        (['--count', '0'], "'0', expected at least 1, a whole number"),
        (['--count', '1.5'], "'1.5', expected at least 1, a whole number"),
        (['--unknown'], 'unrecognized arguments: --unknown'),
    ],
)
def test_a_wrong_option_is_one_line(
    capsys: pytest.CaptureFixture[str], words: list[str], message: str
) -> None:
    with pytest.raises(SystemExit) as ended:
        parser().parse_args(words)
    assert ended.value.code == 2
    text = capsys.readouterr().err
    assert text.startswith('it: error: ')
    assert text.count('\n') == 1
    assert message in text


@given(st.one_of(st.floats(), st.integers(), st.text(max_size=5)))
def test_a_number_is_finite_and_of_its_range(value: object) -> None:
    for parse, low in ((number(ge=0), 0.0), (number(), float('-inf')), (whole(ge=1), 1)):
        with suppress(ArgumentTypeError):
            assert low <= parse(str(value)) < float('inf')


def test_paths(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('HOME', str(tmp_path))
    (tmp_path / 'runs').mkdir()
    (tmp_path / 'plan.csv').write_text('')
    assert path('~/new') == folder('~/new') == file('~/new') == tmp_path / 'new'
    assert folder('~/runs') == tmp_path / 'runs'
    wrong: list[tuple[Callable[[str], Any], str, str]] = [
        (folder, '~/plan.csv', 'is a file, expected a folder'),
        (file, '~/runs', 'is a folder, expected the name of a file'),
        (path, '', 'expected a path'),
    ]
    for parse, text, message in wrong:
        with pytest.raises(ArgumentTypeError, match=message):
            parse(text)


@pytest.mark.parametrize('encoding', ['latin-1', 'ascii', 'utf-8'])
def test_no_letter_is_too_strange_for_a_terminal(
    monkeypatch: pytest.MonkeyPatch, encoding: str
) -> None:
    terminal = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    monkeypatch.setattr(sys, 'stdout', terminal)
    parser().parse_args([])
    print('R² of A,B,… −1', flush=True)
    shown = terminal.buffer.getvalue().decode(encoding)  # type: ignore[attr-defined]
    assert shown == ('R² of A,B,… −1\n' if encoding == 'utf-8' else shown)
    assert 'A,B,' in shown


def test_help_on_such_a_terminal() -> None:
    done = subprocess.run(
        [sys.executable, '-m', 'hexapod_doe.analyze', '--help'],
        env={**os.environ, 'PYTHONIOENCODING': 'ascii'},
        capture_output=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, b'')
    assert b'--table' in done.stdout


def test_every_command_line_is_such_a_one() -> None:
    sources = [
        source
        for package in ('hexapod_sim', 'hexapod_cpg', 'hexapod_agent', 'hexapod_doe')
        for source in (ROOT / package / package).rglob('*.py')
    ]
    sources += (ROOT / 'ros_ws/src/hexapod_bringup/hexapod_bringup').glob('*.py')
    assert len(sources) > 100
    made = [source.name for source in sources if ' argparse.ArgumentParser(' in source.read_text()]
    assert made == []


def test_an_error_of_the_system_names_its_file(tmp_path: Path) -> None:
    with pytest.raises(OSError, match='directory') as caught:
        (tmp_path / 'no' / 'file').write_text('')
    assert one_line(caught.value) == f'{tmp_path / "no" / "file"}: no such file or directory'
    assert one_line(ValueError('two\n  lines')) == 'two lines'
