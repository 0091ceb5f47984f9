# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a cut recording held of a run is in the bag of the recording that goes on, all of it."""

from functools import cache

import pytest
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_doe.bags.bag_file import BagFile
from hexapod_doe.bags.carry_over import carry_over, cut_episodes, find_cut
from hexapod_doe.bags.recording import Recording
from hexapod_doe.bags.rosbag2 import Topic
from hexapod_doe.bags.run_record import read_run
from hexapod_doe.bags.salvage import set_aside
from hexapod_doe.bags.verify import digest, verify
from hexapod_doe.errors import BagError

PERIOD_NS = 25_000_000
EPISODE_NS = 15_000_000_000


@pytest.fixture
def record(samples):
    """Return a function that records episodes; the second is a sampled one that lost samples."""
    # A message serialised twice differs in its padding, which nobody initialises.
    serialised_result, serialised_joints = map(
        cache, (samples.serialised_result, samples.serialised_joints)
    )

    def add(recording: Recording, episodes: range, namespace: str = '/w0') -> None:
        joints = Topic(f'{namespace}/joint_states', samples.joints.type_name)
        results = Topic(f'{namespace}/episode_result', samples.results.type_name)
        for episode in episodes:
            end_ns = (episode + 1) * EPISODE_NS
            if episode == 1:
                recording.begin_sample(1, [joints])
                for back in (600, 3, 0):
                    stamp = end_ns - back * PERIOD_NS
                    recording.add_sample(joints.name, serialised_joints(stamp))
                recording.end_sample(end_ns)
            recording.add_result(results, serialised_result(episode), episode, 600)

    return add


def recording_at(path, **metadata: str) -> Recording:
    return Recording('r1', path, metadata, PERIOD_NS)


def resume(bag, keep: int, topic: str = '/w0/episode_result') -> tuple[Recording, int]:
    set_aside(bag, takeover=True)
    cut = find_cut(bag, 'r1', keep)
    assert cut is not None
    recording = recording_at(bag)
    return recording, carry_over(recording, cut, keep, topic)


@pytest.mark.parametrize('keep', [1, 2, 3])
@pytest.mark.parametrize('namespace', ['/w0', '/lab/w7'])
def test_resumed_bag_equals_the_undisturbed_one(tmp_path, record, keep, namespace):
    whole = recording_at(tmp_path / 'whole')
    record(whole, range(4))
    bag = tmp_path / 'r1'
    record(recording_at(bag), range(3))
    recording, end_ns = resume(bag, keep, f'{namespace}/episode_result')
    assert end_ns == keep * EPISODE_NS
    record(recording, range(keep, 4), namespace)
    undisturbed, resumed = whole.finish(4, {}), recording.finish(4, {})
    verify(resumed)
    assert digest(resumed) == digest(undisturbed)
    assert all(topic.startswith(f'{namespace}/') for topic in BagFile(resumed).types)
    first, second = (read_run(b).metadata for b in (undisturbed, resumed))
    for key in ('incomplete', 'sampled_episodes', 'episodes', 'digest'):
        assert first[key] == second[key].replace(namespace, '/w0')
    assert 'missing' in first['incomplete']


def test_newest_cut_that_holds_enough_is_found(tmp_path, record):
    bag = tmp_path / 'r1'
    for episodes in (3, 2):
        record(recording_at(bag), range(episodes))
        set_aside(bag, takeover=True)
    assert find_cut(bag, 'r1', 2) == tmp_path / 'r1.cut_2'
    assert find_cut(bag, 'r1', 3) == tmp_path / 'r1.cut_1'
    assert find_cut(bag, 'r1', 4) is None
    assert find_cut(bag, 'another', 2) is None
    assert find_cut(tmp_path / 'r2', 'r1', 1) is None


def test_a_cut_of_another_specification_is_none_of_the_run(tmp_path, record):
    bag = tmp_path / 'r1'
    own = RunSpec.load().to_text()
    other = RunSpec.load(None, ['task.closeness_weight=9']).to_text()
    record(recording_at(bag, spec=other), range(3))
    set_aside(bag, takeover=True)
    assert find_cut(bag, 'r1', 2, {'spec': own}) is None
    assert find_cut(bag, 'r1', 2, {'spec': other}) == tmp_path / 'r1.cut_1'
    longer = RunSpec.from_text(other, 'test').with_settings(['training.episodes=9']).to_text()
    assert find_cut(bag, 'r1', 2, {'spec': longer, 'episodes': '9'}) == tmp_path / 'r1.cut_1'


def test_results_of_an_evaluation_are_begun_again(tmp_path, record, samples):
    bag = tmp_path / 'r1'
    evaluation = Topic('/w0/evaluation_result', samples.results.type_name)

    def judge(recording: Recording, starts: int) -> None:
        for start in range(starts):
            recording.add_result(evaluation, samples.serialised_result(start), start, 600)

    cut = recording_at(bag, evaluation='2')
    record(cut, range(3))
    judge(cut, 1)
    with pytest.raises(BagError, match='1 of 2 results of its evaluation recorded'):
        cut.finish(3, {})
    set_aside(bag)
    recording = recording_at(bag, evaluation='2')
    carry_over(recording, find_cut(bag, 'r1', 2), 2, '/w0/episode_result')
    record(recording, range(2, 3))
    judge(recording, 2)
    verify(recording.finish(3, {}))
    assert list(read_run(bag).evaluation.index) == [0, 1]


def test_a_cut_of_another_version_cannot_go_on(tmp_path, record, monkeypatch):
    bag = tmp_path / 'r1'
    record(recording_at(bag), range(3))
    set_aside(bag, takeover=True)
    assert find_cut(bag, 'r1', 2) is not None
    monkeypatch.setattr('hexapod_doe.bags.carry_over.definition', lambda name: 'bool other')
    assert find_cut(bag, 'r1', 2) is None


@pytest.mark.parametrize('share', [0.0, 0.3, 0.6, 0.95])
def test_file_cut_anywhere_gives_its_first_episodes(tmp_path, record, share):
    bag = tmp_path / 'r1'
    record(recording_at(bag), range(4))
    file = set_aside(bag, takeover=True) / 'r1_0.mcap'
    content = file.read_bytes()
    file.write_bytes(content[: int(share * len(content))])
    numbers = [episode.result.episode for episode in cut_episodes(file)]
    assert numbers == list(range(len(numbers)))
    assert len(numbers) < 4
    for keep in range(1, 5):
        assert (find_cut(bag, 'r1', keep) is not None) == (keep <= len(numbers))


def test_verify_names_what_is_not_as_recorded(tmp_path, record):
    recording = recording_at(tmp_path / 'r1')
    record(recording, range(3))
    bag = recording.finish(3, {})
    metadata = (bag / 'metadata.yaml').read_text()
    for old, new, complaint in (
        ('message_count: 3', 'message_count: 2', 'holds 6 messages, expected'),
        ('/w0/joint_states', '/w0/other', 'messages of /w0/other, expected 3'),
    ):
        (bag / 'metadata.yaml').write_text(metadata.replace(old, new, 1))
        with pytest.raises(BagError, match=complaint):
            verify(bag)
    (bag / 'metadata.yaml').write_text(metadata)
    verify(bag)
    file = bag / 'r1_0.mcap'
    content = bytearray(file.read_bytes())
    begin = content.rindex(b'\x28\xb5\x2f\xfd') + 12  # in the last chunk, zstd by its magic
    content[begin : begin + 16] = bytes(255 ^ byte for byte in content[begin : begin + 16])
    file.write_bytes(content)
    with pytest.raises(BagError):
        verify(bag)


def test_folders_of_other_names_are_passed_over(tmp_path, record):
    bag = tmp_path / 'r1'
    recording = recording_at(bag)
    record(recording, range(2))
    recording.abandon()
    cut = set_aside(bag)
    for name in ('r1.cut_old', 'r1.cut_', 'r1.cut_1_2', 'r1x.cut_7', 'r1.cut_-3'):
        (tmp_path / name).mkdir()
    assert find_cut(bag, 'r1', 2) == cut
    assert find_cut(bag, 'r1', 4_000_000_000) is None
