# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A folder like the project's, in which pages are executed and may write."""

from pathlib import Path

import pytest
from page_commands import ROOT

_LINKED = (
    'examples', 'hexapod_agent', 'hexapod_cpg', 'hexapod_doe', 'hexapod_sim', 'ros_ws',
    'setup.bash', 'tests', 'docs', '.venv',
)  # fmt: skip


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with the project's files, and with bags of its own beside the samples."""
    folder = tmp_path / 'project'
    (folder / 'bags').mkdir(parents=True)
    for name in _LINKED:
        (folder / name).symlink_to(ROOT / name)
    for name in ('sample', 'sample_campaign'):
        (folder / 'bags' / name).symlink_to(ROOT / 'bags' / name)
    monkeypatch.chdir(folder)
    return folder
