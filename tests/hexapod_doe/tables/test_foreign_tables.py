# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Tables as people have them give the numbers of the plain one, or one line that names the fault.

The inputs of `tests/data/cases` are one campaign, `good.csv`, in the forms of many programs.
"""

import csv
import io
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from hexapod_doe.errors import AnalysisError
from hexapod_doe.tables.csv_table import read_csv, read_responses
from hexapod_doe.tables.table import RunTable
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

CASES = Path(__file__).parents[2] / 'data' / 'cases'
NUMBERS = [*'ABCDEFG', 'response', 'case', 'label']
MINUS = ('-', '−', '–')
SMALL = pd.read_csv(CASES / 'small.csv').drop(columns=['case', 'replicate'])


def one(name: str, response: str = 'y') -> RunTable:
    (table,) = read_csv(CASES / name, response)
    return table


@pytest.fixture(scope='module')
def good() -> RunTable:
    table = one('good.csv')
    assert table.caveats == ()
    return table


@pytest.mark.parametrize(
    ('name', 'notes'),
    [
        ('s02_excel_blank_rows', []),
        ('s02_trailing_comma', []),
        ('s03_blank_after_C', []),
        ('s03_blanks_after_commas', []),
        ('s03_lower_case_c', ["Column 'c' of s03_lower_case_c.csv is read as 'C'."]),
        (
            's04_semicolon_decimal_comma',
            [
                'The columns of s04_semicolon_decimal_comma.csv are parted by semicolons.',
                "'166,4' of s04_semicolon_decimal_comma.csv is read as 166.4.",
            ],
        ),
        (
            's04_quoted_decimal_comma',
            ["'166,4' of s04_quoted_decimal_comma.csv is read as 166.4."],
        ),
        ('s05_utf16', ['s05_utf16.csv is read as UTF-16 text.']),
        (
            's09_unicode_minus',
            ['The sign − (U+2212 or a dash) of s09_unicode_minus.csv is read as a minus.'],
        ),
    ],
)
def test_the_same_numbers_and_what_was_assumed(
    good: RunTable, name: str, notes: list[str]
) -> None:
    table = one(f'{name}.csv')
    pd.testing.assert_frame_equal(table.rows[NUMBERS], good.rows[NUMBERS])
    assert list(table.caveats) == notes


def test_base_and_fold_are_one_table() -> None:
    table = one('s01_base_and_fold.csv')
    assert len(table.rows) == table.rows['case'].nunique() == 64
    # The fold's runs come after those of the base, though both count from 1.
    assert table.rows['run_order'].sort_values().tolist() == list(range(1, 65))
    assert table.rows['run_order'][:32].max() == 32
    assert any('RunOrder come again with other levels' in text for text in table.caveats)


def test_runs_that_minitab_marks_as_missing(good: RunTable) -> None:
    table = one('s06_minitab.csv', 'Reward')
    kept = good.rows.drop(index=[3, 40]).reset_index(drop=True)
    pd.testing.assert_series_equal(table.rows['response'], kept['response'])
    assert '2 rows have no response and are left out (row 4, 41).' in table.caveats
    assert any('not used: CenterPt, Blocks' in text for text in table.caveats)


def test_a_confirmation_table_with_capitals_in_its_name() -> None:
    found = read_responses(CASES / 'S05_CONFIRM.CSV', 'y')
    assert found == {'ACE': [410.0, 411.0, 412.0, 413.0, 414.0]}


@pytest.mark.parametrize(
    ('name', 'words'),
    [
        ('s05_workbook.xlsx', 'workbook; save its sheet as CSV'),
        ('s07_three_columns_y.csv', "heading 'y' fits 3 columns"),
        ('24_dup_y_column.csv', "heading 'y' fits 2 columns"),
        ('25_dup_factor_column.csv', "heading 'A' fits 2 columns"),
        ('s10_design_blank.csv', r"row 2 \(line 3\): column 'design' is blank"),
        ('22_inf_y.csv', r'row 16: response inf, expected a number'),
        ('77_huge.csv', r'row 1: response 45e200, expected a number within'),
    ],
)
def test_what_cannot_be_read_is_refused(name: str, words: str) -> None:
    with pytest.raises(AnalysisError, match=words) as caught:
        read_csv(CASES / name, 'y')
    assert str(caught.value).startswith(str(CASES / name))
    assert '\n' not in str(caught.value)


def test_headings_with_blanks_and_a_text_in_latin_1() -> None:
    assert one('32_space_header_b.csv').factors == tuple('ABCD')
    table = one('40_latin1.csv')
    assert len(table.rows) == 32
    assert 'Columns of 40_latin1.csv that are not used: Température.' in table.caveats


def test_centre_points_of_the_numeric_factors_only() -> None:
    table = one('80_center_partial.csv')
    centre = table.rows[table.levels.eq(0).any(axis=1)]
    assert centre[[*'ABCD']].to_numpy().tolist() == [[0, 0, 1, 1]]
    assert (table.rows['case'] == centre['case'].iloc[0]).sum() == 1


def test_centre_points_that_disagree(tmp_path: Path) -> None:
    text = (CASES / '80_center_partial.csv').read_text() + '0,0,0,0,61\n'
    (tmp_path / 'runs.csv').write_text(text)
    with pytest.raises(AnalysisError, match=r"row 34, column 'A': level 0, .*the same factors"):
        read_csv(tmp_path / 'runs.csv', 'y')


def write(folder: Path, rows: list[list[str]]) -> Path:
    file = folder / 'runs.csv'
    file.write_text('\n'.join(','.join(row) for row in rows) + '\n', encoding='utf-8')
    return file


def small_rows() -> list[list[str]]:
    return [list(SMALL.columns), *SMALL.astype(str).to_numpy().tolist()]


def test_blank_run_numbers_are_not_used(tmp_path: Path) -> None:
    rows = [[*row, str(i)] for i, row in enumerate(small_rows())]
    rows[0][-1], rows[5][-1] = 'RunOrder', ''
    (table,) = read_csv(write(tmp_path, rows), 'y')
    assert table.rows['run_order'].tolist() == list(range(1, 25))
    assert 'RunOrder of runs.csv lack a number in some row and are not used.' in table.caveats


def test_levels_written_as_signs(tmp_path: Path) -> None:
    signs = {'-1': '-', '1': '+'}
    rows = [[*(signs.get(cell, cell) for cell in row[:3]), row[3]] for row in small_rows()]
    (table,) = read_csv(write(tmp_path, rows), 'y')
    assert (table.rows[[*'ABC']].to_numpy() == SMALL[[*'ABC']].to_numpy()).all()
    assert table.caveats[0] == 'Levels + and - of runs.csv are read as 1 and -1.'


def test_a_column_of_levels_that_is_no_factor_is_named(tmp_path: Path) -> None:
    rows = small_rows()
    rows[0][2] = 'speed'
    (table,) = read_csv(write(tmp_path, rows), 'y')
    assert "Of these 'speed' hold levels of -1 and 1" in table.caveats[0]


@st.composite
def dialects(draw: st.DrawFn) -> dict[str, Any]:
    """A program's way to write a table."""
    return {
        'separator': draw(st.sampled_from([',', ';', '\t', '|'])),
        'decimal': draw(st.sampled_from(['.', ','])),
        'minus': draw(st.sampled_from(MINUS)),
        'codec': draw(st.sampled_from(['utf-8', 'utf-8-sig', 'utf-16', 'utf-16-le'])),
        'end': draw(st.sampled_from(['\n', '\r\n', '\r'])),
        'quoting': draw(st.sampled_from([csv.QUOTE_MINIMAL, csv.QUOTE_ALL])),
        'missing': draw(st.sampled_from(['', '*', '.', 'NA', 'n/a', '–'])),
        'spare': draw(st.integers(0, 2)),
        'blank_rows': draw(st.integers(0, 2)),
        'comments': draw(st.sampled_from([[], ['# made by hand'], ['# y, "open', '#']])),
        'blanks': draw(st.sampled_from(['', ' ', '\u00a0'])),
    }


def rendered(rows: pd.DataFrame, how: dict[str, Any]) -> bytes:
    """Write a table as a program would."""

    def cell(value: object) -> str:
        text = how['missing'] if pd.isna(value) else str(value).replace('.', how['decimal'])
        return how['minus'] + text[1:] if text.startswith('-') else text

    out = io.StringIO()
    writer = csv.writer(
        out, delimiter=how['separator'], quoting=how['quoting'], lineterminator='\n'
    )
    spare = [''] * how['spare']
    writer.writerow([how['blanks'] + name + how['blanks'] for name in rows.columns] + spare)
    for row in rows.itertuples(index=False):
        writer.writerow([*map(cell, row), *spare])
        for _ in range(how['blank_rows']):
            writer.writerow([''] * (len(rows.columns) + how['spare']))
    text = ''.join(f'{line}\n' for line in how['comments']) + out.getvalue()
    return text.replace('\n', how['end']).encode(how['codec'])


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=150)
@given(
    dialects(),
    st.lists(st.integers(-(10**8), 10**8), min_size=24, max_size=24, unique=True),
    st.sets(st.integers(0, 23), max_size=4),
)
def test_a_table_in_any_dialect_gives_its_numbers(
    tmp_path: Path, how: dict[str, Any], cents: list[int], missing: set[int]
) -> None:
    values = [None if i in missing else cent / 100 for i, cent in enumerate(cents)]
    rows = SMALL.assign(y=pd.Series(values, dtype=object))
    (tmp_path / 'runs.csv').write_bytes(rendered(rows, how))
    (table,) = read_csv(tmp_path / 'runs.csv', 'y')
    kept = [i for i, value in enumerate(values) if value is not None]
    assert table.rows['response'].tolist() == [values[i] for i in kept]
    levels = SMALL.loc[kept, [*'ABC']].to_numpy()
    assert (table.rows[[*'ABC']].to_numpy() == levels).all()


ODD_LETTERS = {
    'A': 'aАаΑＡÁα𝐀',
    'B': 'bВΒＢвḂ',
    'C': 'cСсＣⒸĆС\u0301',
}


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=200)
@given(
    st.sampled_from([*'ABC']),
    st.text('  \u00a0\t\u200b\ufeff', max_size=2),
    st.data(),
    st.text('  \u00a0_.1x', max_size=2),
    st.booleans(),
)
def test_a_heading_in_any_form_is_read_or_named(
    tmp_path: Path, letter: str, before: str, data: st.DataObject, after: str, explicit: bool
) -> None:
    odd = data.draw(st.one_of(st.sampled_from(ODD_LETTERS[letter] + letter), st.characters(
        exclude_categories=['Cc', 'Cs'], exclude_characters='",;|#')))  # fmt: skip
    rows = small_rows()
    heading = f'{before}{odd}{after}'
    rows[0]['ABC'.index(letter)] = heading
    file = tmp_path / 'runs.csv'
    file.write_text('\n'.join(','.join(row) for row in rows) + '\n', encoding='utf-8')
    try:
        (table,) = read_csv(file, 'y', [*'ABC'] if explicit else None)
    except AnalysisError as error:
        shown = str(error)
    else:
        if {*table.factors} == {*'ABC'}:
            assert (table.rows[[*'ABC']].to_numpy() == SMALL[[*'ABC']].to_numpy()).all()
            return
        shown = ' '.join(table.caveats) + ''.join(table.factors)
    assert ' '.join(heading.strip('\u200b\ufeff').split()).strip('\u200b\ufeff ') in shown


def test_a_centre_point_is_none_of_the_sets() -> None:
    labels = one('80_center_partial.csv').rows['label']
    assert labels.tolist().count('(none)') == 2
    assert labels.iloc[-1] == 'centre CD'


def test_two_plans_of_one_design_in_a_table_are_replicates(tmp_path: Path) -> None:
    # Each plan counts its runs from 1, in an order of its own: run 1 is the same case in both.
    heading, *cases = small_rows()
    rows = [[*heading, 'RunOrder'], *([*row, str(i + 1)] for i, row in enumerate(cases[::3]))]
    second = [[*row[:3], f'{float(row[3]) + 1}', row[4]] for row in rows[1:]]
    second[3][4], second[4][4] = second[4][4], second[3][4]
    (table,) = read_csv(write(tmp_path, [*rows, *second]), 'y')
    assert len(table.rows) == 16
    assert table.rows['run_order'].tolist() == [*range(1, 9), 9, 10, 11, 13, 12, 14, 15, 16]
    assert any('RunOrder come again with other levels' in text for text in table.caveats)
