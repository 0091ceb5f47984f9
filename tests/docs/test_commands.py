# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Every command of the pages is one that its program takes, to the last option and key."""

from pathlib import Path

import pytest
import understood
from page_commands import OURS, ROOT, Block, blocks, commands

PAGES = [
    ROOT / 'README.md',
    *sorted(ROOT.glob('docs/**/*.md')),
    *sorted(ROOT.glob('bags/**/README.md')),
    *sorted(ROOT.glob('examples/*.md')),
    *sorted(ROOT.glob('ros_ws/src/hexapod_bringup/agents/*.md')),
    ROOT / '.github' / 'CONTRIBUTING.md',
]
BLOCKS = [block for page in PAGES for block in blocks(page, 'bash')]


@pytest.mark.parametrize('block', BLOCKS, ids=str)
def test_programs_take_what_the_pages_give_them(
    block: Block, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'runs').mkdir()
    for words in commands(block, tmp_path):
        if words[0] in OURS:
            understood.check(words)
