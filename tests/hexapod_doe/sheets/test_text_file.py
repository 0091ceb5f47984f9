# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Text of any usual encoding comes out the same; what is no text is named, with the cure."""

import gzip
from pathlib import Path

import pytest
from hexapod_doe.errors import TableError
from hexapod_doe.sheets.text_file import read_text

TEXT = 'A,B,Größe\n-1,1,45\n'


@pytest.mark.parametrize(
    ('codec', 'note'),
    [
        ('utf-8', ''),
        ('utf-8-sig', ''),
        ('utf-16', 'UTF-16'),
        ('utf-16-le', 'UTF-16'),
        ('utf-16-be', 'UTF-16'),
        ('utf-32', 'UTF-32'),
        ('cp1252', 'Windows-1252'),
    ],
)
@pytest.mark.parametrize('end', ['\n', '\r\n', '\r'])
def test_every_encoding_gives_the_same_text(
    tmp_path: Path, codec: str, note: str, end: str
) -> None:
    file = tmp_path / 'runs.csv'
    file.write_bytes(TEXT.replace('\n', end).encode(codec))
    text, notes = read_text(file)
    assert text == TEXT
    assert ' '.join(notes) == (f'runs.csv is read as {note} text.' if note else '')


@pytest.mark.parametrize(
    ('content', 'words'),
    [
        (b'', 'empty file'),
        (b' \r\n\r\n', 'empty file'),
        (b'\xef\xbb\xbf', 'empty file'),
        (b'PK\x03\x04rest', 'workbook; save its sheet as CSV'),
        (b'\xd0\xcf\x11\xe0rest', 'workbook; save its sheet as CSV'),
        (gzip.compress(b'A,y\n', mtime=0), 'is compressed; unpack it'),
        (b'%PDF-1.7', 'PDF'),
        (b'A,y\n\x00\x001,2\n' + 99 * b'x', 'is not a text file'),
        (b'A,y\n\x81,1\n', 'no text in Windows-1252; save the table as CSV UTF-8'),
    ],
)
def test_what_is_no_text_is_named(tmp_path: Path, content: bytes, words: str) -> None:
    file = tmp_path / 'runs.csv'
    file.write_bytes(content)
    with pytest.raises(TableError, match=words) as caught:
        read_text(file)
    assert str(caught.value).startswith(str(file))


def test_a_folder_and_nothing_at_all(tmp_path: Path) -> None:
    with pytest.raises(TableError, match='is a folder, expected a table'):
        read_text(tmp_path)
    with pytest.raises(FileNotFoundError, match='no such file, expected a table'):
        read_text(tmp_path / 'runs.csv')
