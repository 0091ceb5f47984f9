# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Options of `analyze` that make no sense are one line with status 2."""

from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
from hexapod_doe.analysis.analyze_arguments import build_parser
from hexapod_doe.errors import AnalysisError
from hexapod_doe.records.options import Options
from hexapod_sim.command_line import options_of

from hexapod_doe import analyze

CASES = Path(__file__).parents[2] / 'data' / 'cases'
SMALL = CASES / 'small.csv'


@pytest.mark.parametrize(
    ('words', 'message'),
    [
        ('--alpha 5', "--alpha: '5', expected a number above 0 and below 1"),
        ('--level 95', '95 % is 0.95'),
        ('--level 1', "--level: '1', expected a number above 0 and below 1"),
        ('--max-order 0', "--max-order: '0', expected at least 1"),
        ('--max-order -1', "--max-order: '-1', expected at least 1"),
        ('--trim-worst -1', "--trim-worst: '-1', expected at least 0"),
        ('--delta nan', "--delta: 'nan', expected a number at least 0"),
        ('--failure-threshold inf', "--failure-threshold: 'inf', expected a number"),
        ('--seed -1', "--seed: '-1', expected at least 0"),
        ('--factors A,A,B', "'A,A,B', expected each letter once"),
        ('--factors ,', 'expected letters such as A,B,C'),
        ('--terms A --max-order 1', 'exclude each other'),
        ('--failure-threshold 1e6', 'failure_threshold 1e+06: no run reaches it'),
        ('--estimand best_of:²', 'expected mean, iqm or best_of:m'),
        ('--response z', "no column 'z' for the response"),
        ('--blocks z', "no column 'z' for blocks"),
        (f'--devices {SMALL}', 'expected the keys'),
        (f'--devices {CASES}', 'is a folder, expected the name of a file'),
        (f'--out {SMALL}', 'is a file, expected a folder'),
        (f'--table {CASES}', 'is a folder, expected a table'),
        (f'--confirm {CASES}/s05_utf16.csv.gz', 'no such file'),
        (f'--table {CASES}/s05_workbook.xlsx', 'save its sheet as CSV'),
    ],
)
def test_one_line_and_status_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: str, message: str
) -> None:
    given = [*f'--table {SMALL} --response y --out {tmp_path / "out"}'.split(), *words.split()]
    try:
        status = analyze.main(given)
    except SystemExit as ended:
        status = ended.code  # type: ignore[assignment]
    assert status == 2
    # On a busy machine lines come before it that say what is under way.
    told = capsys.readouterr().err.splitlines(keepends=True)
    text = ''.join(line for line in told if not line.endswith(' ...\n'))
    assert text.startswith('analyze: ')
    assert text.count('\n') == 1
    assert message in text
    assert not (tmp_path / 'out').exists()


def test_a_table_given_as_bags(capsys: pytest.CaptureFixture[str]) -> None:
    assert analyze.main([str(SMALL), '--out', 'nowhere']) == 2
    assert 'give bags by their folder, and a table by --table' in capsys.readouterr().err


@pytest.mark.parametrize(
    ('values', 'message'),
    [
        ({'alpha': 5.0}, r'alpha 5\.0: expected a number above 0 and below 1'),
        ({'seed': -1}, 'seed -1: expected at least 0'),
        ({'delta': float('nan')}, 'delta nan: expected a number at least 0'),
        ({'terms': 'A', 'max_order': 1}, 'exclude each other'),
    ],
)
def test_callers_meet_the_same_ranges(values: dict[str, Any], message: str) -> None:
    with pytest.raises(AnalysisError, match=message):
        Options(**values)


def test_the_command_line_has_the_defaults_of_the_options() -> None:
    args = build_parser().parse_args(['x', '--out', 'y'])
    given = options_of(Options, args)
    assert Options(**given) == Options()
    assert {field.name for field in fields(Options)} - set(given) == {
        'keep_main_effects', 'confirmation',
    }  # fmt: skip
