# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Rebuilds every figure and number of a study from its committed bags.

    python -m hexapod_doe.studies.answer bags/study --out docs

writes images/study_*.png, data/study/ and what stands between the markers of study.md, of
README.md beside that folder, and of the data sheet in the folder of the bags. Campaigns that are
not finished are left out and named.
"""

import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hexapod_sim.command_line import CommandLine, folder, one_line, path

from hexapod_doe.errors import AnalysisError, BagError, TableError
from hexapod_doe.stages import stage
from hexapod_doe.studies.backtest import Whole, backtest, rule_of_thumb
from hexapod_doe.studies.study_data import read_study
from hexapod_doe.studies.study_figures import figures_of
from hexapod_doe.studies.study_numbers import numbers_of
from hexapod_doe.studies.study_text import answer_tables, data_sheet, headline, replace_block

NUMBERS = 'answer.json'
PAGE, README, SHEET = 'study.md', 'README.md', 'README.md'
_RANKING = 'study_ranking'
_CAPTIONS = {
    'study_ranking': 'All 128 sets, ranked',
    'study_effects': 'Effects of the sensors',
    'study_atlas': 'Effects of the sensors by task',
    'study_learning': 'Learning curves of all runs',
    'study_confirmation': 'Confirmation runs',
    'study_backtest': 'Would fewer runs have been enough?',
}


def rebuild(study: Path, out: Path) -> dict[str, Any]:
    """Write figures and numbers, and return the record of the numbers.

    Raises:
        BagError: A bag cannot be read.
        AnalysisError: A campaign cannot be analysed.
        OSError: A file cannot be written.
    """
    with stage('answer: reading and analysing the campaigns'):
        found = read_study(study)
    tested, rule = None, ''
    if found.main is not None:
        with stage('answer: drawing smaller campaigns'):
            whole = Whole.of(found.main.table)
            tested = backtest(found.main.table, whole)
            rule = rule_of_thumb(whole, tested)
    record = numbers_of(found, tested, rule)
    images, data = out / 'images', out / 'data' / 'study'
    for each in (images, data):
        each.mkdir(parents=True, exist_ok=True)
    with stage('answer: drawing the figures'):
        for old in images.glob('study_*.png'):
            old.unlink()
        for chart in figures_of(found, tested, rule):
            chart.save(images, data)
    lines = json.dumps(record, indent=1, ensure_ascii=False, allow_nan=False)
    (data / NUMBERS).write_text(f'{lines}\n', encoding='utf-8')
    return record


def blocks(record: Mapping[str, Any], images: Path) -> dict[str, str]:
    """Return the texts between the markers, by page: those of the study's page and the README.

    Args:
        record: The numbers.
        images: The folder of the figures.
    """
    drawn = [name for name in _CAPTIONS if (images / f'{name}.png').is_file()]
    pictures = '\n\n'.join(f'![{_CAPTIONS[name]}](images/{name}.png)' for name in drawn)
    head = headline(record)
    if _RANKING in drawn:
        head += f'\n\n![{_CAPTIONS[_RANKING]}](docs/images/{_RANKING}.png)'
    return {'page': '\n\n'.join(filter(None, (answer_tables(record), pictures))), 'readme': head}


def write_pages(record: Mapping[str, Any], study: Path, out: Path) -> None:
    """Replace what stands between the markers of the pages that there are.

    Raises:
        ValueError: A page has no markers.
    """
    texts = blocks(record, out / 'images')
    pages = {out / PAGE: texts['page'], out.resolve().parent / README: texts['readme']}
    for page, text in {**pages, study / SHEET: data_sheet(record)}.items():
        if page.is_file():
            old = page.read_text(encoding='utf-8')
            page.write_text(replace_block(old, 'answer', text), encoding='utf-8')


def main(arguments: Sequence[str] | None = None) -> int:
    """Rebuild the answer; return 0, or 2 where a bag or a page cannot be read or written."""
    args = _parser().parse_args(arguments)
    try:
        record = rebuild(args.study, args.out)
        write_pages(record, args.study, args.out)
    except (AnalysisError, BagError, TableError, ValueError, OSError) as error:
        print(f'answer: {one_line(error)}', file=sys.stderr)
        return 2
    print(headline(record))
    for each in record['left_out']:
        print(f'not finished, and left out: {each}')
    return 0


def _parser() -> CommandLine:
    parser = CommandLine(prog='answer', description=__doc__)
    parser.add_argument('study', type=path, help='folder above those of the campaigns')
    parser.add_argument('--out', type=folder, required=True, metavar='DIR', help='such as docs')
    return parser


if __name__ == '__main__':
    sys.exit(main())
