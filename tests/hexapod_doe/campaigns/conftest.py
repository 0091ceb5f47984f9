# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The folder of a small campaign, with rows in any state that a test needs."""

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from hexapod_doe.bags.recording import Recording
from hexapod_doe.bags.rosbag2 import Topic
from hexapod_doe.bags.run_bag import EPISODE_RESULT

STEPS = 600
PLAN = """\
StdOrder,RunOrder,case,replicate,seed,run_id,observations,A,B
1,4,1,1,11,r1,,-1,-1
2,3,2,1,12,r2,A,1,-1
3,2,3,1,13,r3,B,-1,1
4,1,4,1,14,r4,AB,1,1
"""


class Folder:
    """A campaign of four rows, run in the order r4 r3 r2 r1, of five episodes each."""

    def __init__(self, directory: Path, samples: SimpleNamespace) -> None:
        self.directory = directory
        self._samples = samples
        (directory / 'plan.csv').write_text(PLAN)
        self.open: list[Recording] = []

    def begin(self, run_id: str, results: int, worker: str = '/w1', **metadata: str) -> Recording:
        """Record some results of a run, which stays open."""
        bag = self.directory / 'runs' / run_id
        recording = Recording(run_id, bag, {'episodes': '5', **metadata}, 0)
        topic = Topic(f'{worker}/episode_result', EPISODE_RESULT)
        for episode in range(results):
            data = self._samples.serialised_result(episode, run_id)
            recording.add_result(topic, data, episode, STEPS)
        self.open.append(recording)
        return recording

    def cut(self, run_id: str, results: int, worker: str = '/w1') -> None:
        """Leave a run as a recorder does that is stopped before the end."""
        self.begin(run_id, results, worker).abandon()
        self.open.pop()

    def finish(self, run_id: str, worker: str = '/w1') -> None:
        """Record a whole run."""
        self.begin(run_id, 5, worker).finish(5, {})
        self.open.pop()


@pytest.fixture
def folder(tmp_path: Path, samples: SimpleNamespace) -> Iterator[Folder]:
    """Yield a campaign's folder in which nothing has been run."""
    made = Folder(tmp_path, samples)
    yield made
    for recording in made.open:
        recording.abandon()


@pytest.fixture
def mixed(folder: Folder) -> Folder:
    """Return a campaign with a row in every state that the bags show."""
    folder.finish('r4', '/w1')
    folder.begin('r3', 2, '/w2')
    folder.cut('r2', 1, '/w1')
    return folder
