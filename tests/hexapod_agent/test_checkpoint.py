# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A resumed run is the uninterrupted one to the last bit; a broken file is refused by name."""

import pickle

import pytest
import torch
from hexapod_agent.env import HexapodLine
from hexapod_agent.train import train_episode

from hexapod_agent import checkpoint


def advance(trainer, episodes: int) -> None:
    env = HexapodLine(trainer.spec.letters, trainer.config)
    for _ in range(episodes):
        train_episode(env, trainer)


def flatten(value, prefix=''):
    """Every leaf of a nested state, by path."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from flatten(part, f'{prefix}/{key}')
    else:
        yield prefix, value


def assert_same(first, second) -> None:
    left, right = (dict(flatten(t.state_dict(to_resume=True))) for t in (first, second))
    assert left.keys() == right.keys()
    for path, value in left.items():
        if isinstance(value, torch.Tensor):
            assert torch.equal(value, right[path]), path
        else:
            assert value == right[path], path


@pytest.mark.parametrize('name', ['small_config', 'switched_config'])
def test_resumed_run_equals_the_uninterrupted_one(make_trainer, tmp_path, request, name):
    config = request.getfixturevalue(name)
    whole = make_trainer(config=config)
    advance(whole, 4)
    part = make_trainer(config=config)
    advance(part, 2)
    checkpoint.save(tmp_path / 'a.pt', part, to_resume=True)
    resumed = checkpoint.load(tmp_path / 'a.pt')
    advance(resumed, 2)
    assert resumed.returns == whole.returns
    assert_same(resumed, whole)


def test_kill_in_mid_episode_repeats_that_episode(make_trainer, tmp_path):
    whole = make_trainer()
    advance(whole, 3)
    killed = make_trainer()
    advance(killed, 2)
    checkpoint.save(tmp_path / 'a.pt', killed, to_resume=True)
    # Ten steps into the third episode the process dies; only the file remains.
    env = HexapodLine('BC', killed.config)
    seen, _ = env.reset(seed=killed.seed, options={'episode': 2})
    killed.begin_episode(2)
    for _ in range(10):
        action = killed.observe(seen, env.outcome)
        killed.learn()
        seen = env.step(action)[0]
    resumed = checkpoint.load(tmp_path / 'a.pt')
    advance(resumed, 1)
    assert_same(resumed, whole)


def test_small_checkpoint_acts_alike(make_trainer, tmp_path):
    trainer = make_trainer()
    advance(trainer, 1)
    checkpoint.save(tmp_path / 'small.pt', trainer, to_resume=False)
    checkpoint.save(tmp_path / 'large.pt', trainer, to_resume=True)
    assert (tmp_path / 'small.pt').stat().st_size < (tmp_path / 'large.pt').stat().st_size
    loaded = checkpoint.load(tmp_path / 'small.pt')
    seen = torch.rand(1, trainer.spec.size)
    assert torch.equal(loaded.agent.act(seen), trainer.agent.act(seen))
    assert (loaded.seed, loaded.spec.letters, loaded.config) == (5, 'BC', trainer.config)
    with pytest.raises(checkpoint.CheckpointError, match='holds an agent alone, expected a run'):
        checkpoint.load(tmp_path / 'small.pt', to_resume=True)


def test_failed_write_leaves_the_old_file(make_trainer, tmp_path, monkeypatch):
    path = tmp_path / 'a.pt'
    trainer = make_trainer()
    checkpoint.save(path, trainer, to_resume=False)
    before = path.read_bytes()

    def fail(content, file):
        file.write(b'part')
        raise OSError('disk full')

    monkeypatch.setattr(torch, 'save', fail)
    with pytest.raises(OSError, match='disk full'):
        checkpoint.save(path, trainer, to_resume=False)
    assert path.read_bytes() == before


@pytest.mark.parametrize('share', [0.0, 0.3, 0.99])
def test_truncated_file_is_refused(make_trainer, tmp_path, share):
    path = tmp_path / 'a.pt'
    checkpoint.save(path, make_trainer(), to_resume=False)
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(checkpoint.CheckpointError, match=r'a.pt.*expected a whole file'):
        checkpoint.load(path)


def test_missing_and_foreign_files_are_refused(tmp_path):
    with pytest.raises(checkpoint.CheckpointError, match=r'no.pt.*not found'):
        checkpoint.load(tmp_path / 'no.pt')
    torch.save({'weights': torch.zeros(1)}, tmp_path / 'other.pt')
    with pytest.raises(checkpoint.CheckpointError, match='expected format'):
        checkpoint.load(tmp_path / 'other.pt')


class Payload:
    def __reduce__(self):
        return (exec, ('raise SystemExit("code ran")',))


def test_code_in_a_file_does_not_run(tmp_path):
    (tmp_path / 'evil.pt').write_bytes(pickle.dumps(Payload(), protocol=2))
    with pytest.raises(checkpoint.CheckpointError, match='cannot be read'):
        checkpoint.load(tmp_path / 'evil.pt')
    torch.save({'format': Payload()}, tmp_path / 'evil2.pt')
    with pytest.raises(checkpoint.CheckpointError, match='cannot be read'):
        checkpoint.load(tmp_path / 'evil2.pt')
