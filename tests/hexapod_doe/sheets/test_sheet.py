# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The headings are found where they are, lines keep their numbers, and no field is lost."""

from pathlib import Path

import pytest
from hexapod_doe.errors import TableError
from hexapod_doe.sheets.sheet import Sheet, read_sheet


def read(folder: Path, text: str, *wanted: str) -> Sheet:
    (folder / 'runs.csv').write_text(text, encoding='utf-8')
    return read_sheet(folder / 'runs.csv', wanted or ['y'])


@pytest.mark.parametrize(
    'text',
    [
        'A,B,y\n1,2,3\n',
        'A;B;y\n1;2;3\n',
        'A\tB\ty\n1\t2\t3\n',
        'A|B|y\n1|2|3\n',
        'A B y\n1 2 3\n',
        '  A   B  y\n  1   2  3\n',
        '"A","B","y"\n"1","2","3"\n',
        'sep=;\nA;B;y\n1;2;3\n',
        '# A,B,y\n1,2,3\n',
        '#A B y\n1 2 3\n',
        'A,B,y,,\n1,2,3,,\n',
        'Rewards of May,,\n,,\nA,B,y\n,,\n1,2,3\n\n',
        '# y is the reward\nA,B,y\n# a comment, "open\n1,2,3\n',
        'Results for y\nA,B,y\n1,2,3\n',
    ],
)
def test_one_table_in_many_forms(tmp_path: Path, text: str) -> None:
    sheet = read(tmp_path, text)
    assert sheet.headings == ('A', 'B', 'y')
    assert [sheet.column(i).tolist() for i in range(3)] == [['1'], ['2'], ['3']]


def test_rows_keep_their_line_numbers(tmp_path: Path) -> None:
    sheet = read(tmp_path, '# made by hand\n\nA,note,y\n1,"two\nlines",3\n\n# dropped\n4,,6\n')
    assert sheet.cells.index.tolist() == [4, 8]
    assert sheet.notes == ('runs.csv: 2 lines (1, 7) are left out: # comes first.',)


def test_headings_with_blanks_no_break_spaces_and_line_breaks(tmp_path: Path) -> None:
    sheet = read(tmp_path, '\u00a0A ,"mean\nreward"\u200b\n1,2\n', 'mean reward')
    assert sheet.headings == ('A', 'mean reward')


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        ('A,B,y\n1,2,3\n1,2\n', 'line 3: 2 fields, expected 3'),
        ('A,B,y\n1,2,3,4\n', 'line 2: 4 fields, expected 3'),
        ('A,B,y\n1,"2,3\n1,2,3\n', 'line 2: .*is a quote left open'),
        ('# nothing\n#\n', 'no line but blank ones and comments'),
    ],
)
def test_lines_that_do_not_fit(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(TableError, match=words):
        read(tmp_path, text)


def test_without_the_wanted_heading_the_first_line_is_shown(tmp_path: Path) -> None:
    assert read(tmp_path, 'run id;my reward\n1;2\n').headings == ('run id', 'my reward')
