# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What README and tutorials show is executed, page by page, with the sizes of small_sizes.py."""

import os
import re
import subprocess
import sys
from pathlib import Path
from pkgutil import resolve_name

import pytest
from page_commands import NEVER, QUICK, ROOT, SLOW, Block, blocks, commands, stand_ins
from ros2_mini.cli import main as ros2
from small_sizes import small
from understood import console_main

PAGES = [
    ROOT / 'README.md',
    *sorted((ROOT / 'docs' / 'tutorials').glob('*.md')),
    ROOT / 'bags' / 'README.md',
]
_FILE = re.compile(r'`([\w.]+\.yaml)`:?$', re.MULTILINE)
_DIFFERS = 1
_SET_UP = """
export SLURM_ARRAY_TASK_ID=3
seq() { echo 1; echo 2; }
set -eux
"""
_SHIM = """#!{python}
import os, sys
sys.path.insert(0, '{support}')
from small_sizes import small
words = small(['{name}', *sys.argv[1:]])
os.execv('{program}', ['{program}', *words[1:]])
"""


def write_files(page: Path, folder: Path) -> None:
    """Write the YAML files that a page names in the line before a block."""
    names = _FILE.findall(page.read_text(encoding='utf-8'))
    for name, block in zip(names, blocks(page, 'yaml'), strict=False):
        (folder / name).write_text(block.text)


def carry_out(words: list[str]) -> int:
    """Run a command in this process, and return its status."""
    program, *given = words
    try:
        if program == 'ros2' and given[0] == 'run':
            status = resolve_name(console_main(*given[1:3]))(given[3:])
        elif program == 'ros2':
            status = ros2(given)
        elif given[0] == '-m':
            status = resolve_name(f'{given[1]}:main')(given[2:])
        else:
            told = subprocess.run([sys.executable, *given], check=False)
            status = told.returncode
    except SystemExit as error:
        return error.code if isinstance(error.code, int) else int(bool(error.code))
    return status or 0


def statuses(words: list[str]) -> tuple[int, ...]:
    """Return what a command may end with: `shadow` says by 1 that two agents differ."""
    return (0, _DIFFERS) if 'shadow' in words else (0,)


@pytest.mark.parametrize('page', PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_quick_commands_and_python_run(page: Path, project: Path, tmp_path: Path) -> None:
    write_files(page, project)
    for block in [block for block in blocks(page, 'bash') if block.run == QUICK]:
        for words in commands(block, tmp_path / 'shell'):
            assert carry_out(small(words)) in statuses(words), f'{block}: {" ".join(words)}'
    for block in blocks(page, 'python'):
        exec(compile(block.text, str(block), 'exec'), {'__name__': '__main__'})


def script(page: Path) -> str:
    """Return what a page has a shell do, but for what is never run."""
    code = [block for block in blocks(page, 'bash') if block.run != NEVER]
    return '\n'.join([_SET_UP, *(f'(\n{block.text})' for block in code)])


def has_slow(page: Path) -> bool:
    return any(block.run == SLOW for block in blocks(page, 'bash'))


@pytest.mark.slow
@pytest.mark.timeout(3600)
@pytest.mark.usefixtures('own_domain')
@pytest.mark.parametrize(
    'page', [page for page in PAGES if has_slow(page)], ids=lambda page: page.stem
)
def test_a_page_runs_from_top_to_bottom(page: Path, project: Path, tmp_path: Path) -> None:
    write_files(page, project)
    programs = {'ros2': ROOT / 'ros_ws/src/ros2_mini/bin/ros2', 'python': sys.executable}
    shims = {
        name: _SHIM.format(
            python=sys.executable, support=ROOT / 'tests/support', name=name, program=program
        )
        for name, program in programs.items()
    }
    stand_ins(tmp_path / 'bin', shims)
    path = os.pathsep.join((str(tmp_path / 'bin'), os.environ['PATH']))
    told = subprocess.run(
        ['bash', '-c', script(page)], env=os.environ | {'PATH': path}, cwd=project,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert told.returncode == 0, told.stdout[-4000:] + told.stderr[-4000:]


def test_a_command_that_fails_is_noticed(project: Path) -> None:
    assert carry_out(['ros2', 'run', 'hexapod_doe', 'campaign_status', 'bags/gone']) == 2


def test_every_block_says_where_it_runs() -> None:
    said: set[str] = {block.run for page in PAGES for block in all_blocks(page)}
    assert said <= {QUICK, SLOW, NEVER}


def all_blocks(page: Path) -> list[Block]:
    return [*blocks(page, 'bash'), *blocks(page, 'python')]
