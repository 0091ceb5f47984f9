# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The examples of docs/tutorials/batch.md are what a shell, Kubernetes and `run_case` accept."""

import re
import shlex
import subprocess
from pathlib import Path

import pytest
import yaml
from hexapod_doe.run_case import parser

TEXT = (Path(__file__).parents[2] / 'docs' / 'tutorials' / 'batch.md').read_text()
COMMANDS = re.findall(r'ros2 run hexapod_doe run_case\s+(--[^\n]*(?:\n\s+--[^\n]*)?)', TEXT)


def blocks(language: str) -> list[str]:
    return re.findall(rf'```{language}\n(.*?)```', TEXT, re.DOTALL)


@pytest.mark.parametrize('command', COMMANDS)
def test_each_command_is_understood(command):
    row_number = re.sub(r'\$\(\(.*?\)\)|"\$\w+"|\{\}', '17', command)
    args = parser().parse_args(shlex.split(row_number))
    assert args.row == 17
    assert args.plan.name == 'plan.csv'


def test_four_commands_are_shown():
    assert len(COMMANDS) == 4


def test_the_array_job_is_a_shell_script():
    (job,) = [text for text in blocks('bash') if text.startswith('#!/bin/bash\n#SBATCH')]
    subprocess.run(['bash', '-n'], input=job, text=True, check=True)


def test_the_indexed_job_names_its_volume_and_counts_its_rows():
    job = yaml.safe_load(*blocks('yaml'))
    pod = job['spec']['template']['spec']
    (container,) = pod['containers']
    assert job['spec']['completionMode'] == 'Indexed'
    assert {m['name'] for m in container['volumeMounts']} == {v['name'] for v in pod['volumes']}
    (script,) = container['args']
    assert '$((JOB_COMPLETION_INDEX + 1))' in script
    subprocess.run(['bash', '-n'], input=script, text=True, check=True)
