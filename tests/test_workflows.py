# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Hosted workflows and the container ask for what is there, as far as that can be seen offline.

actionlint knows more (`pre-commit run actionlint --all-files`).
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[1]
WORKFLOWS = sorted((ROOT / '.github' / 'workflows').glob('*.yml'))
DOCKERFILE = (ROOT / 'docker' / 'Dockerfile').read_text(encoding='utf-8')


def steps(workflow: Path) -> list[dict]:
    """Return the steps of all jobs of a workflow."""
    jobs = yaml.safe_load(workflow.read_text(encoding='utf-8'))['jobs']
    return [step for job in jobs.values() for step in job['steps']]


def scripts(workflow: Path) -> list[str]:
    """Return the scripts of all jobs of a workflow."""
    return [step['run'] for step in steps(workflow) if 'run' in step]


@pytest.fixture(scope='module')
def verbs() -> set[str]:
    """Return the verbs of the Makefile."""
    text = (ROOT / 'Makefile').read_text(encoding='utf-8')
    return set(re.findall(r'^([a-z-]+):', text, re.MULTILINE))


@pytest.mark.parametrize('workflow', WORKFLOWS, ids=lambda file: file.name)
def test_each_verb_of_a_workflow_is_one_of_the_makefile(workflow: Path, verbs: set[str]) -> None:
    asked = set(re.findall(r'\bmake ([a-z-]+)', '\n'.join(scripts(workflow))))
    assert asked <= verbs


@pytest.mark.parametrize('workflow', WORKFLOWS, ids=lambda file: file.name)
def test_scripts_are_read_by_bash(workflow: Path) -> None:
    for script in scripts(workflow):
        plain = re.sub(r'\$\{\{.*?\}\}', 'x', script)
        ended = subprocess.run(['bash', '-n'], input=plain, capture_output=True, text=True)
        assert ended.returncode == 0, ended.stderr


@pytest.mark.parametrize('workflow', WORKFLOWS, ids=lambda file: file.name)
def test_requirements_that_a_workflow_names_are_there(workflow: Path) -> None:
    text = '\n'.join(scripts(workflow))
    named = re.findall(r'-r (\S+\.txt)', text)
    assert [name for name in named if not (ROOT / name).is_file()] == []
    pins = dict(re.findall(r'(\w+)==([\w.]+)', text))
    wanted = (ROOT / 'requirements-stock.txt').read_text(encoding='utf-8').split()
    assert [f'{name}=={pin}' for name, pin in pins.items() if f'{name}=={pin}' not in wanted] == []


@pytest.mark.parametrize('workflow', WORKFLOWS, ids=lambda file: file.name)
def test_a_failure_before_a_pipe_is_one(workflow: Path) -> None:
    """Without a shell named, hosted runners have bash without pipefail."""
    settings = yaml.safe_load(workflow.read_text(encoding='utf-8'))
    job_shells = {str(job.get('defaults', {})) for job in settings['jobs'].values()}
    for step in steps(workflow):
        if '|' in step.get('run', '').replace('||', ''):
            assert step.get('shell') == 'bash' or all('bash' in shell for shell in job_shells)


def test_the_container_copies_what_its_first_layer_reads(verbs: set[str]) -> None:
    copied = [word for line in re.findall(r'^COPY (.*)$', DOCKERFILE, re.MULTILINE)
              for word in line.split()[:-1]]  # fmt: skip
    assert all(list(ROOT.glob(pattern)) for pattern in copied if pattern != '.')
    assert set(re.findall(r'make ([a-z-]+)$', DOCKERFILE, re.MULTILINE)) <= verbs
