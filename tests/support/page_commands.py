# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The code of the pages: its blocks, and the commands that a shell makes of them.

A comment in the line before a block says where it is run, if not in the quick suite:
`<!-- run: slow -->`, or `<!-- run: never; the reason -->` for what needs a robot, another host, a
registry. What is never run is parsed all the same.
"""

import re
import shutil
import subprocess
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
QUICK, SLOW, NEVER = 'quick', 'slow', 'never'
_FENCED = re.compile(
    r'(?:^ *<!-- run: (\w+).*? -->\n)?^( *)```(\w*)\n(.*?)^ *```$', re.MULTILINE | re.DOTALL
)
_INDENTED = re.compile(
    r'(?:^<!-- run: (\w+).*? -->\n)?(?:(?<=\n\n)|(?<=-->\n))((?: {4}.*\n|\n(?= {4}))+)',
    re.MULTILINE,
)
OURS = ('ros2', 'make', 'python')
"""Programs whose arguments are held against what they take."""
_OTHERS = ('git', 'apt', 'apt-get', 'sbatch', 'scancel', 'kubectl', 'docker', 'python3', 'pip')
_SHELL = """
source() { :; }
cd() { mkdir -p "$1" && builtin cd "$1"; }
seq() { echo "$1"; }
nproc() { echo 1; }
export CALLS SLURM_ARRAY_TASK_ID=17 JOB_COMPLETION_INDEX=16
set -eu
"""
_STUB = """#!/bin/sh
{ printf '%s\\0' "$(basename "$0")" "$@"; printf '\\001\\0'; } >> "$CALLS"
"""


@dataclass(frozen=True)
class Block:
    """A piece of code on a page."""

    page: Path
    line: int
    language: str
    text: str
    run: str

    def __str__(self) -> str:
        return f'{self.page.relative_to(ROOT)}:{self.line}'


def blocks(page: Path, language: str) -> list[Block]:
    """Return the blocks of a page in a language, in order; an indented one is of the shell."""
    return [block for block in _blocks(page) if block.language == language]


def _blocks(page: Path) -> Iterator[Block]:
    text = page.read_text(encoding='utf-8')
    found = [(match, *match.groups()) for match in _FENCED.finditer(text)]
    for match, run, indent, language, code in found:
        plain = re.sub(rf'^{indent}', '', code, flags=re.MULTILINE)
        yield Block(page, _line(text, match), language or 'text', plain, run or QUICK)
    without = _FENCED.sub(lambda match: '\n' * match[0].count('\n'), text)
    for match in _INDENTED.finditer(without):
        plain = re.sub(r'^ {4}', '', match[2], flags=re.MULTILINE)
        yield Block(page, _line(without, match), 'bash', typed(plain), match[1] or QUICK)


def typed(code: str) -> str:
    """Return what is typed of a session that also shows what is printed; all of another block."""
    lines = [line.removeprefix('$ ') for line in code.splitlines(True) if line.startswith('$ ')]
    return ''.join(lines) if code.startswith('$ ') else code


def _line(text: str, match: re.Match[str]) -> int:
    return text.count('\n', 0, match.start()) + 1


def commands(block: Block, folder: Path) -> list[list[str]]:
    """Return the words of each command that bash makes of a block, none of which is carried out.

    Args:
        block: of the shell.
        folder: an empty one, for what stands in for the programs.

    Raises:
        ValueError: bash cannot read it, or it calls a program that no page needs.
    """
    calls = folder / 'calls'
    calls.unlink(missing_ok=True)
    for place in ('bin', '.venv/bin'):
        stand_ins(folder / place)
    told = subprocess.run(
        ['bash', '-c', f'{_SHELL}\n{block.text}'],
        cwd=folder, text=True, capture_output=True, check=False, timeout=60.0,
        env={'PATH': f'{folder / "bin"}:/usr/bin:/bin', 'CALLS': str(calls), 'HOME': str(folder)},
    )  # fmt: skip
    if told.returncode:
        raise ValueError(f'{block}: {told.stderr.strip()}')
    words = calls.read_text().split('\0') if calls.exists() else []
    return list(_split(words))


def edited(page: Path, package: str, folder: Path) -> None:
    """Copy a package into a folder, with the edits of it that a page shows as a diff."""
    source, ignored = ROOT / package / package, shutil.ignore_patterns('__pycache__')
    shutil.copytree(source, folder / package, ignore=ignored)
    for block in blocks(page, 'diff'):
        subprocess.run(
            ['git', 'apply', '-p2', '--whitespace=nowarn'],
            cwd=folder, input=block.text, text=True, check=True,
        )  # fmt: skip


def stand_ins(folder: Path, scripts: Mapping[str, str] | None = None) -> None:
    """Write programs that note their words, or what else they are to do."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in (*OURS, *_OTHERS):
        (folder / name).write_text((scripts or {}).get(name, _STUB))
        (folder / name).chmod(0o755)


def _split(words: list[str]) -> Iterator[list[str]]:
    command: list[str] = []
    for word in words[:-1]:
        if word == '\1':
            yield command
            command = []
        else:
            command.append(word)
