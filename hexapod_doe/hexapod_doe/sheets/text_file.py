# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The text of a file whose encoding is not known, or one line on what the file is instead."""

import codecs
from pathlib import Path

from hexapod_doe.errors import TableError

# The longer mark first: that of UTF-32 begins with that of UTF-16.
_MARKS = (
    (codecs.BOM_UTF8, 'utf-8', 'UTF-8'),
    (codecs.BOM_UTF32_LE, 'utf-32-le', 'UTF-32'),
    (codecs.BOM_UTF32_BE, 'utf-32-be', 'UTF-32'),
    (codecs.BOM_UTF16_LE, 'utf-16-le', 'UTF-16'),
    (codecs.BOM_UTF16_BE, 'utf-16-be', 'UTF-16'),
)
_WORKBOOK = 'an Excel or OpenDocument workbook; save its sheet as CSV and give that file'
_NOT_TEXT = (
    (b'PK\x03\x04', _WORKBOOK),
    (b'\xd0\xcf\x11\xe0', _WORKBOOK),
    (b'%PDF', 'a PDF document; give the table as CSV'),
    (b'\x1f\x8b', 'compressed; unpack it and give the CSV file'),
    (b'\x28\xb5\x2f\xfd', 'compressed; unpack it and give the CSV file'),
    (b'\x89MCAP', "a recording; give its bag's folder as BAGS, not as a table"),
)
INVISIBLE = dict.fromkeys(map(ord, '\u00ad\u200b\u200c\u200d\u200e\u200f\u2060\ufeff'))
"""Letters that nothing shows, which come with what is copied from pages; for `str.translate`."""

_SAMPLE = 4096
_NUL_SHARE = 0.3
"""Share of the sample's even or odd bytes that are NUL, above which it is UTF-16."""


def read_text(path: Path) -> tuple[str, tuple[str, ...]]:
    r"""Return a file's text, its lines ended by `\n`, and what was assumed to read it.

    Letters that nothing shows are left out.

    Raises:
        TableError: The path is a folder, or the file is empty or not a text.
        FileNotFoundError: There is no such file.
        OSError: The file cannot be read.
    """
    if path.is_dir():
        raise TableError(f'{path}: is a folder, expected a table: the path of its CSV file')
    if not path.exists():
        raise FileNotFoundError(f'{path}: no such file, expected a table in CSV')
    raw = path.read_bytes()
    for start, what in _NOT_TEXT:
        if raw.startswith(start):
            raise TableError(f'{path}: is {what}')
    codec, name = _encoding(raw)
    try:
        text = raw.decode(codec).translate(INVISIBLE)
    except UnicodeDecodeError as error:
        raise TableError(
            f'{path}: byte {error.start} is no text in {name}; save the table as CSV UTF-8'
        ) from error
    if '\0' in text:
        raise TableError(f'{path}: is not a text file; save the table as CSV and give that file')
    if not text.strip():
        raise TableError(f'{path}: empty file, expected a header and one row per run')
    notes = () if name == 'UTF-8' else (f'{path.name} is read as {name} text.',)
    return text.replace('\r\n', '\n').replace('\r', '\n'), notes


def _encoding(raw: bytes) -> tuple[str, str]:
    """Return the codec of a file and what people call it."""
    for mark, codec, name in _MARKS:
        if raw.startswith(mark):
            return codec, name
    sample = raw[:_SAMPLE]
    for offset, codec in ((1, 'utf-16-le'), (0, 'utf-16-be')):
        part = sample[offset::2]
        if part and part.count(0) > _NUL_SHARE * len(part):
            return codec, 'UTF-16'
    try:
        raw.decode('utf-8')
    except UnicodeDecodeError:
        return 'cp1252', 'Windows-1252'
    return 'utf-8', 'UTF-8'
