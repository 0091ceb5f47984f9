# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import shutil
from pathlib import Path

import pytest
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.campaigns.folder import read_progress
from hexapod_doe.studies.publish import main

SAMPLE = Path(__file__).parents[3] / 'bags' / 'sample_campaign'


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """A study of one campaign, of which two rows are done."""
    study = tmp_path / 'study'
    (study / 'main' / 'runs').mkdir(parents=True)
    for plan in ('plan.csv', 'plan.json'):
        shutil.copy(SAMPLE / plan, study / 'main')
    for run in sorted((SAMPLE / 'runs').iterdir())[:2]:
        shutil.copytree(run, study / 'main' / 'runs' / run.name)
    return study


def test_finished_runs_are_copied_once(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    to = tmp_path / 'published'
    (study / 'main' / 'runs' / 'notes.txt').write_text('mine')
    assert main([str(study), str(to)]) == 0
    assert capsys.readouterr().out.startswith('2 runs copied; ')
    assert main([str(study), str(to)]) == 0
    assert capsys.readouterr().out.startswith('0 runs copied; ')
    assert sorted(path.name for path in (to / 'main').iterdir()) == [
        'plan.csv', 'plan.json', 'runs',
    ]  # fmt: skip
    assert len(list((to / 'main' / 'runs').iterdir())) == 2
    runs = [
        {name: run.returns for name, run in read_progress(each / 'main').runs.items()}
        for each in (study, to)
    ]
    assert runs[0] == runs[1]


def test_another_plan_or_run_of_the_name_is_refused(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    to = tmp_path / 'published'
    assert main([str(study), str(to)]) == 0
    first, second = sorted((study / 'main' / 'runs').iterdir())
    copy = to / 'main' / 'runs' / first.name
    shutil.rmtree(copy)
    shutil.copytree(second, copy)
    kept = list(BagFile(copy).messages())
    assert main([str(study), str(to)]) == 2
    assert 'digest' in capsys.readouterr().err
    assert list(BagFile(copy).messages()) == kept

    (to / 'main' / 'plan.csv').write_text('another')
    assert main([str(study), str(to)]) == 2
    assert 'another plan than' in capsys.readouterr().err
