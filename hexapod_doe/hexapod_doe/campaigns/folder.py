# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Reads a campaign's progress from its folder alone, also while it runs and after a crash."""

from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from mcap.records import Channel, McapRecord, Message, Metadata, Schema
from mcap_ros2.decoder import DecoderFactory

from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.rosbag2 import partial_path
from hexapod_doe.bags.run_bag import EPISODE_RESULT, RUN_RECORD, is_evaluation
from hexapod_doe.bags.run_identity import settings
from hexapod_doe.bags.salvage import whole_records
from hexapod_doe.bags.verify import verify
from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_doe.campaigns.failures import read_failures
from hexapod_doe.campaigns.progress import Progress, Run, State
from hexapod_doe.campaigns.row import Row, read_rows
from hexapod_doe.campaigns.stop_rule import stopped_text
from hexapod_doe.errors import BagError, LockingError
from hexapod_doe.file_lock import lock

_BEGAN, _ENDED = 'recording_began', 'recording_ended'


def read_progress(directory: Path, known: Mapping[str, Run] | None = None) -> Progress:
    """Read what the plan and the bags of a campaign's folder say.

    Args:
        directory: with the plan and its bags.
        known: runs that were read before; those that were done are not read again.

    Raises:
        FileNotFoundError: there is no plan.
        hexapod_doe.designs.plan_file.PlanError: its file is not a plan.
    """
    had = {run.run_id: run for run in (known or {}).values() if run.state is State.DONE}
    rows = read_rows(directory / PLAN_FILE)
    runs = [had.get(row.run_id) or read_row(row) for row in rows]
    _add_failures(runs, read_failures(directory))
    legend = rows[0].treatments.legend
    named = {run.run_id: run for run in runs}
    return Progress(directory.resolve().name, named, legend, stopped_text(directory))


def _add_failures(runs: Sequence[Run], reasons: Mapping[str, Sequence[str]]) -> None:
    """Tell what failed: what was tried in vain, and neither was done since nor is under way."""
    for run in runs:
        if run.run_id in reasons and run.state in (State.DUE, State.INTERRUPTED):
            run.state, run.reason = State.FAILED, reasons[run.run_id][-1]


def read_row(row: Row) -> Run:
    """Read how far a row is from its bag, whole, unfinished or not there."""
    run = Run(row.run_id, row.label)
    partial = partial_path(row.bag)
    bag = row.bag_state()
    if bag.other:
        run.state, run.reason = State.OTHER, bag.other
    elif bag.whole:
        run.state = State.DONE
        _read_whole(run, BagFile(row.bag))
    elif partial.is_dir():
        file = partial / f'{row.bag.name}_0.mcap'
        run.state = State.RUNNING if _held(file) else State.INTERRUPTED
        _read_unfinished(run, file)
    elif bag.damage:
        run.state, run.reason = State.DAMAGED, bag.damage
    run.settings = row.without_varied(run.settings)
    return run


def verify_done(progress: Progress, directory: Path) -> int:
    """Read back every bag of a done row; what is not as recorded becomes damaged.

    Returns:
        How many bags were found to be what was recorded.
    """
    sound = 0
    bags = {row.run_id: row.bag for row in read_rows(directory / PLAN_FILE)}
    for run in progress.having(State.DONE):
        try:
            verify(bags[run.run_id])
            sound += 1
        except BagError as error:
            run.state, run.reason = State.DAMAGED, str(error)
    return sound


def _read_whole(run: Run, file: BagFile) -> None:
    """Take from a closed bag what it says of its run."""
    topic = file.result_topic()
    metadata = file.run_metadata()
    _fill(run, metadata, topic, [result for _, result in file.decoded(topic)])
    run.seconds = _seconds(metadata, _time(metadata, _ENDED))


def _read_unfinished(run: Run, file: Path) -> None:
    """Take from a file that is being written, or was cut, what it says up to its last chunk."""
    kept = _Kept()
    try:
        with file.open('rb') as stream:
            for record in whole_records(stream):
                kept.take(record)
        last_write = datetime.fromtimestamp(file.stat().st_mtime, UTC)
    except FileNotFoundError:  # not made yet, or closed meanwhile
        return
    if kept.metadata:
        _fill(run, kept.metadata, kept.topic, kept.results)
        run.seconds = _seconds(kept.metadata, last_write)


def _seconds(metadata: Mapping[str, str], ended: datetime | None) -> float:
    began = _time(metadata, _BEGAN)
    return max(0.0, (ended - began).total_seconds()) if began and ended else 0.0


def _time(metadata: Mapping[str, str], key: str) -> datetime | None:
    return datetime.fromisoformat(metadata[key]) if key in metadata else None


def _fill(run: Run, metadata: Mapping[str, str], topic: str, results: Sequence[Any]) -> None:
    returns = {result.episode: result.episode_return for result in results}
    run.returns = [returns[episode] for episode in sorted(returns)]
    run.worker = topic.rsplit('/', 1)[0]
    run.planned = int(metadata['episodes'])
    run.settings = settings(metadata)
    run.earlier = min(int(metadata.get('resumed', '0')), len(returns))
    if results:
        run.reward = results[-1].average_return


class _Kept:
    """What the records of an unfinished file say of its run."""

    def __init__(self) -> None:
        self.metadata: Mapping[str, str] = {}
        """As it was at the beginning, with the number of episodes that were to come."""
        self.topic = ''
        self.results: list[Any] = []
        self._schema: Schema | None = None
        self._decode: dict[int, Callable[[bytes], Any] | None] = {}

    def take(self, record: McapRecord) -> None:
        match record:
            case Metadata(name=name) if name == RUN_RECORD and not self.metadata:
                self.metadata = record.metadata
            case Schema(name=name) if name == EPISODE_RESULT:
                self._schema = record
            case Channel() if self._is_of_results(record):
                self.topic = record.topic
                decoders = DecoderFactory()
                self._decode[record.id] = decoders.decoder_for('cdr', self._schema)
            case Message():
                decode = self._decode.get(record.channel_id)
                if decode is not None:
                    self.results.append(decode(record.data))

    def _is_of_results(self, channel: Channel) -> bool:
        known = self._schema is not None and channel.schema_id == self._schema.id
        return known and not is_evaluation(channel.topic)


def _held(file: Path) -> bool:
    """Whether a recorder has the file open; its lock goes with its process."""
    try:
        with file.open('rb') as stream:
            if file.stat().st_size == 0:  # its lock comes before its first byte
                return True
            lock(stream, shared=True)
    except (FileNotFoundError, BlockingIOError):  # not made yet; held
        return True
    except LockingError:  # no recorder writes here; this was copied from elsewhere
        return False
    return False
