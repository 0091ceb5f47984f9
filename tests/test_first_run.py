# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A first `make setup` tells what it does, and takes no CUDA where there is no GPU."""

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PIP = """\
Collecting numpy==2.4.6
  Downloading numpy-2.4.6-cp311-cp311-manylinux_2_28_x86_64.whl (16.9 MB)
  Downloading https://files/a/zstandard-0.25.0-cp311.whl (560 kB)
  Downloading torch-2.13.0.whl.metadata (300 bytes)
  Downloading nvidia_cublas-13.1-py3-none.whl (1200.5 MB)
Installing collected packages: numpy, torch
"""


def progress(script: str) -> list[str]:
    """Return what is shown of a script's output, with a word of ours after a second of silence."""
    ended = subprocess.run(
        ['bash', '-c', f'({script}) | {ROOT}/.ci/progress 1'],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    return ended.stdout.splitlines()


def test_large_downloads_are_named_and_all_are_added_up(tmp_path: Path) -> None:
    (tmp_path / 'pip').write_text(PIP)
    assert progress(f'cat {tmp_path}/pip') == [
        '  16 MB: numpy-2.4.6 (16.9 MB)',
        '  1217 MB: nvidia_cublas-13.1-py3-none.whl (1200.5 MB)',
        '  1217 MB downloaded, unpacking',
    ]


def test_many_small_downloads_are_told_by_their_sum() -> None:
    shown = progress('for k in {1..40}; do echo "  Downloading p$k-1.0.tar.gz (2.0 MB)"; done')
    assert shown == ['  50 MB: p25-1.0.tar.gz (2.0 MB)']


def test_silence_is_filled_and_no_line_torn_by_it() -> None:
    shown = progress("printf 'Installing coll'; sleep 1.3; echo 'ected packages: a'; sleep 1.3")
    assert [line.split(': ')[-1].strip() for line in shown] == [
        'still at work', '0 MB downloaded, unpacking', 'still unpacking',
    ]  # fmt: skip


# Stands in for the environment's Python: notes pip's arguments, and knows an index or none.
PYTHON = """#!/bin/bash
if [ "$1" = - ]; then exit {has_torch}; fi
echo "$*" >> {notes}
case "$*" in *{index}*) exit {answers} ;; esac
"""


@pytest.fixture
def libraries(tmp_path: Path):
    """Return what installs into an environment of stand-ins, and gives back pip's calls."""
    (tmp_path / 'bin').mkdir()

    def install(torch: str, answers: bool = True, has_torch: bool = False) -> tuple[str, list]:
        index, notes, python = 'http://nowhere/cpu', tmp_path / 'notes', tmp_path / 'bin/python'
        python.write_text(
            PYTHON.format(
                notes=notes, index=index, answers=int(not answers), has_torch=int(not has_torch)
            )
        )
        python.chmod(0o755)
        ended = subprocess.run(
            [ROOT / '.ci/libraries', tmp_path, 'all of it', '-r', 'requirements.txt'],
            env=os.environ | {'TORCH': torch, 'TORCH_INDEX': index},
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        calls = notes.read_text().splitlines() if notes.exists() else []
        return ended.stdout + ended.stderr, calls

    return install


def test_without_a_gpu_torch_comes_first_and_from_the_index_of_cpu_builds(libraries) -> None:
    said, (torch, rest) = libraries('cpu')
    assert 'Installing all of it' in said
    assert 'CUDA' not in said
    (pinned,) = [
        line for line in (ROOT / 'requirements.txt').read_text().split() if 'torch' in line
    ]
    assert torch.endswith(f'--index-url http://nowhere/cpu {pinned}')
    assert '--no-deps' in torch
    assert rest.endswith('-r requirements.txt')


def test_where_that_index_does_not_answer_it_is_told_what_comes(libraries) -> None:
    said, calls = libraries('cpu', answers=False)
    assert 'no torch without CUDA at http://nowhere/cpu' in said
    assert len(calls) == 2


def test_with_cuda_the_size_is_told_and_pip_has_its_way(libraries) -> None:
    said, calls = libraries('cuda')
    assert 'GB more to download (TORCH=cpu takes none)' in said
    assert len(calls) == 1


def test_a_torch_that_is_there_is_not_looked_for(libraries) -> None:
    _, calls = libraries('cpu', has_torch=True)
    assert len(calls) == 1


def test_an_unknown_torch_is_one_line(libraries) -> None:
    said, calls = libraries('rocm')
    assert "TORCH is 'rocm', expected cpu or cuda" in said
    assert calls == []
