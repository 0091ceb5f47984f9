# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""TensorBoard files hold the numbers of episodes.csv, also after a run has been resumed."""

import csv
import errno
import math
import struct

import pytest
from hexapod_agent.learning.event_log import EventLog, scalars
from hexapod_agent.learning.metrics import in_order
from hexapod_agent.learning.summary import EpisodeSummary
from hexapod_agent.train import EVENTS, LOG, train
from tensorboardX.proto.event_pb2 import Event, SessionLog


def read_events(directory) -> list[Event]:
    """Decode TFRecords: length (8 bytes), its checksum (4), an event, its checksum (4)."""
    events = []
    for path in sorted(directory.glob('events.*'), key=lambda path: path.stat().st_mtime_ns):
        data = path.read_bytes()
        while data:
            (length,) = struct.unpack('<Q', data[:8])
            events.append(Event.FromString(data[12 : 12 + length]))
            data = data[length + 16 :]
    return events


def curves(directory) -> dict[str, dict[int, float]]:
    """Return value by step by tag, as TensorBoard shows them."""
    shown: dict[str, dict[int, float]] = {}
    for event in read_events(directory):
        if event.session_log.status == SessionLog.START:
            for points in shown.values():
                for step in [step for step in points if step >= event.step]:
                    del points[step]
        for value in event.summary.value:
            shown.setdefault(value.tag, {})[event.step] = value.simple_value
    return shown


def summary(episode: int, critic_loss: float) -> EpisodeSummary:
    return EpisodeSummary(
        episode, 600, 10.0 + episode, 9.0, {'alive': 2.0}, False, 'time_limit',
        in_order({'critic_loss': critic_loss, 'saturated_share': 0.25, 'entropy': 1.5}),
    )  # fmt: skip


def test_points_of_an_episode(tmp_path):
    with EventLog(tmp_path) as log:
        log.add(summary(0, math.nan))
        log.add(summary(1, 0.5))
    found = curves(tmp_path)
    assert found['return/episode'] == {0: 10.0, 1: 11.0}
    assert found['term/alive'] == {0: 2.0, 1: 2.0}
    assert found['learner/saturated_share'] == {0: 0.25, 1: 0.25}
    assert found['learner/critic_loss'] == {1: 0.5}  # unknown before the first update
    assert found['learner/entropy'] == {0: 1.5, 1: 1.5}  # a name that the table does not know
    shown = scalars(summary(0, 0.0))
    assert found.keys() == {tag for tag, value in shown.items() if math.isfinite(value)}


def test_a_log_that_goes_on_hides_what_it_repeats(tmp_path):
    for first, reward in ((0, 0.0), (1, 100.0)):
        with EventLog(tmp_path, first) as log:
            for episode in range(first, 3 - first):
                log.add(summary(episode, reward))
    assert curves(tmp_path)['learner/critic_loss'] == {0: 0.0, 1: 100.0}


def test_training_writes_them_beside_its_table(make_trainer, tmp_path):
    trainer = make_trainer()
    train(trainer, 2, tmp_path)
    train(trainer, 3, tmp_path)
    with (tmp_path / LOG).open(newline='') as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 3
    found = curves(tmp_path / EVENTS)
    for row in rows:
        episode = int(row['episode'])
        # The files hold float32.
        expected = pytest.approx(float(row['episode_return']), rel=1e-6)
        assert found['return/episode'][episode] == expected
        assert found['term/velocity'][episode] == pytest.approx(float(row['term_velocity']), 1e-5)


def test_full_disk_is_an_error_and_no_hang(tmp_path):
    log = EventLog(tmp_path)
    log._writer.write_event = refuse
    with pytest.raises(OSError, match=rf"No space left on device: '{tmp_path}'"):
        log.add(summary(0, 0.5))
    log.close()


def refuse(event) -> None:
    raise OSError(errno.ENOSPC, 'No space left on device')
