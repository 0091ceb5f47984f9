# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import subprocess
from pathlib import Path

import pytest
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_doe.designs.design import fraction
from hexapod_doe.designs.plan_file import write_plan
from hexapod_doe.designs.plan_table import make_plan
from hexapod_doe.studies import run_study
from hexapod_doe.studies.run_study import estimate, main, parts_of

ROOT = Path(__file__).parents[3]


@pytest.fixture
def study(tmp_path: Path) -> Path:
    plan = make_plan(fraction('eighth'), 2)
    for name in ('article', 'main', 'main/confirm', 'rough'):
        write_plan(plan, tmp_path / name / 'plan.csv')
    return tmp_path


def test_the_main_campaign_comes_first_and_then_its_confirmation(study: Path) -> None:
    names = [part.folder.relative_to(study).as_posix() for part in parts_of(study)]
    assert names == ['main', 'main/confirm', 'article', 'rough']


def test_the_estimate_adds_up(study: Path) -> None:
    text = estimate(parts_of(study), workers=2)
    one = parts_of(study)[0].seconds_per_run
    spec = RunSpec.load()
    episodes = spec.training.episodes + 0.1 * spec.training.evaluation  # which has no updates
    assert one == pytest.approx(episodes * spec.task.time_limit_steps * 0.0037)
    assert f'{study}/main: 32 of 32 runs left, about {32 * one / 7200:.1f} h' in text
    assert text.endswith(f'about {4 * 32 * one / 7200:.1f} h in all with 2 workers')


def test_fewer_updates_take_less_time(tmp_path: Path) -> None:
    swift = ROOT / 'hexapod_agent' / 'hexapod_agent' / 'swift.yaml'
    main = run_study.plan_command.main
    for name, options in (('swift', ['--config', str(swift)]), ('article', [])):
        main(['--replicates', '1', '--out', str(tmp_path / name / 'plan.csv'), *options])
    article, cheap = parts_of(tmp_path)
    # 140 episodes and 1000, and 20 without updates.
    expected = (140 * (0.1 + 0.9 / 8) + 2) / (1000 + 2)
    assert cheap.seconds_per_run / article.seconds_per_run == pytest.approx(expected, rel=1e-6)


def test_each_campaign_has_its_turn_on_live_workers(
    study: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    called: list[list[str]] = []
    monkeypatch.setattr(
        subprocess, 'run', lambda command, check: called.append(command)
    )  # trains nothing
    assert main([str(study), '--workers', '3']) == 1
    assert len(called) == 4
    assert called[0][:4] == ['ros2', 'launch', 'hexapod_bringup', 'campaign.launch.xml']
    assert called[0][4:] == [f'plan:={study}/main/plan.csv', 'record_every:=0', 'local_workers:=3']
    assert f'{study}/rough is not finished' in capsys.readouterr().err


def test_an_empty_folder_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(tmp_path)]) == 2
    assert 'no campaign, expected folders with a plan.csv' in capsys.readouterr().err


def test_git_takes_plans_and_finished_runs_of_the_study_alone() -> None:
    study = 'bags/study/main'
    kept = ['plan.csv', 'plan.json', 'runs/a/metadata.yaml', 'runs/a/a_0.mcap']
    kept += [f'confirm/{name}' for name in kept]
    left = ['progress.html', 'logs/w1.log', 'runs/a.partial/a_0.mcap', 'runs/a.checkpoint/x.pt',
            'campaign.lock', 'runs/a.row', 'report/index.html']  # fmt: skip
    paths = [f'{study}/{name}' for name in (*kept, *left)]
    found = subprocess.run(
        ['git', 'check-ignore', '--no-index', *paths],
        cwd=ROOT, capture_output=True, text=True, check=True,
    ).stdout.split()  # fmt: skip
    assert found == [f'{study}/{name}' for name in left]
