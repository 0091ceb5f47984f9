# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A resumed run is the uninterrupted one to the last bit; a broken file is refused by name."""

import pickle
from functools import partial
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
import torch
from hexapod_agent.deployment import agent_file
from hexapod_agent.deployment.agent_file import CheckpointError
from hexapod_agent.deployment.sealed_file import write_sealed
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_agent.train import train_episode

AGENTS = Path(__file__).parents[3] / 'ros_ws' / 'src' / 'hexapod_bringup' / 'agents'


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
    left, right = (dict(flatten(t.state_dict())) for t in (first, second))
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
    checkpoint.save(tmp_path / 'a.pt', part)
    resumed = checkpoint.load(tmp_path / 'a.pt')
    advance(resumed, 2)
    assert resumed.returns == whole.returns
    assert_same(resumed, whole)


@pytest.mark.slow
@pytest.mark.timeout(1200)
@pytest.mark.parametrize('cut', [12, 22])
def test_swift_yaml_resumes_while_its_actor_waits_and_after_it(tmp_path, cut: int):
    """Its actor waits for 1500 updates, 75 an episode: it moves from episode 20 on."""
    config = RunSpec.load(files('hexapod_agent') / 'swift.yaml').observing('ABCDE')
    whole, part = Trainer(config, 3), Trainer(config, 3)
    before = whole.learner.policy().layers[0][0].copy()
    advance(whole, 20)
    assert np.array_equal(whole.learner.policy().layers[0][0], before)
    advance(whole, 4)
    assert not np.array_equal(whole.learner.policy().layers[0][0], before)
    advance(part, cut)
    checkpoint.save(tmp_path / 'a.pt', part)
    resumed = checkpoint.load(tmp_path / 'a.pt')
    advance(resumed, 24 - cut)
    assert resumed.returns == whole.returns
    assert_same(resumed, whole)


def test_kill_in_mid_episode_repeats_that_episode(make_trainer, tmp_path):
    whole = make_trainer()
    advance(whole, 3)
    killed = make_trainer()
    advance(killed, 2)
    checkpoint.save(tmp_path / 'a.pt', killed)
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
    checkpoint.save_agent(tmp_path / 'small.pt', trainer)
    checkpoint.save(tmp_path / 'large.pt', trainer)
    assert (tmp_path / 'small.pt').stat().st_size < (tmp_path / 'large.pt').stat().st_size
    loaded = agent_file.load(tmp_path / 'small.pt')
    seen = np.random.default_rng(0).uniform(-1, 1, trainer.spec.size).astype(np.float32)
    np.testing.assert_array_equal(loaded.policy(seen), trainer.learner.act(seen, explore=False))
    assert (loaded.seed, loaded.spec.letters, loaded.config) == (5, 'BC', trainer.config)
    with pytest.raises(CheckpointError, match='holds an agent alone, expected a run'):
        checkpoint.load(tmp_path / 'small.pt')


def test_failed_write_leaves_the_old_file(make_trainer, tmp_path, monkeypatch):
    path = tmp_path / 'a.pt'
    trainer = make_trainer()
    checkpoint.save_agent(path, trainer)
    before = path.read_bytes()

    def fail(content, file):
        file.write(b'part')
        raise OSError('disk full')

    monkeypatch.setattr(torch, 'save', fail)
    with pytest.raises(CheckpointError, match=r'a.pt.*cannot be written: disk full'):
        checkpoint.save_agent(path, trainer)
    assert path.read_bytes() == before


def content_of_before(trainer) -> dict:
    """What checkpoints held before they held a policy."""
    run = {'episode': trainer.episode, 'returns': trainer.returns}
    return {'seed': trainer.seed, 'state': run | trainer.learner.state_dict()}


def write_unsealed(path, trainer) -> None:
    """Write a checkpoint as it was written before files had a seal."""
    config = {'config': trainer.config.to_mapping(), 'observations': trainer.spec.letters}
    content = {'format': 'hexapod-checkpoint-1'} | config | content_of_before(trainer)
    torch.save(content, path)


def write_without_policy(path, trainer) -> None:
    """Write a checkpoint as it was written before it held the policy apart."""
    spec = {'format': 'hexapod-checkpoint-2', 'spec': trainer.config.to_mapping()}
    write_sealed(path, partial(torch.save, spec | content_of_before(trainer)))


def mutated(content: bytes, rng: np.random.Generator) -> bytes:
    """Return a file's content with one fault of a disk or a transfer."""
    at, length = int(rng.integers(len(content))), int(rng.integers(1, 5000))
    kind = rng.choice(['flip', 'cut', 'zero', 'insert', 'remove', 'swap'])
    if kind == 'flip':
        return content[:at] + bytes([content[at] ^ 1 << rng.integers(8)]) + content[at + 1 :]
    if kind == 'cut':
        return content[:at]
    if kind == 'zero':
        return content[:at] + bytes(len(content[at : at + length])) + content[at + length :]
    if kind == 'insert':
        return content[:at] + rng.bytes(length) + content[at:]
    if kind == 'remove':
        return content[:at] + content[at + length :]
    other = int(rng.integers(len(content)))
    first, second = sorted((at, other))
    blocks = content[first : first + 512], content[second : second + 512]
    if second - first < 512 or len(blocks[1]) < 512:
        return content + b'\n'
    between, rest = content[first + 512 : second], content[second + 512 :]
    return content[:first] + blocks[1] + between + blocks[0] + rest


def loaded_or_refused(path):
    """Return the trainer of a checkpoint, and why there is none."""
    try:
        return checkpoint.load(path), ''
    except CheckpointError as error:
        return None, str(error)


def check_mutations(path, trainer, count: int) -> int:
    """Load a checkpoint after each of many faults; return how many were refused."""
    content, rng, refused = path.read_bytes(), np.random.default_rng(1), 0
    for _ in range(count):
        path.write_bytes(mutated(content, rng))
        loaded, reason = loaded_or_refused(path)
        if loaded is None:
            assert str(path) in reason
            assert '\n' not in reason
            refused += 1
        else:
            assert_same(loaded, trainer)
    return refused


@pytest.mark.parametrize('count', [60, pytest.param(1500, marks=pytest.mark.slow)])
@pytest.mark.parametrize('write', [checkpoint.save, write_unsealed])
def test_damage_is_refused_or_harmless(make_trainer, tmp_path, write, count):
    trainer = make_trainer()
    advance(trainer, 2)
    path = tmp_path / 'a.pt'
    write(path, trainer)
    # A file without a seal has bytes that no checksum covers, and nothing reads.
    least = 0.95 if write is checkpoint.save else 0.5
    assert check_mutations(path, trainer, count) >= least * count


@pytest.mark.parametrize('share', [0.0, 0.3, 0.99])
def test_truncated_file_is_refused(make_trainer, tmp_path, share):
    path = tmp_path / 'a.pt'
    checkpoint.save_agent(path, make_trainer())
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(CheckpointError, match=r'a.pt.*expected a whole file'):
        agent_file.load(path)


@pytest.mark.parametrize('cut', [1, 40, 81])
def test_a_lost_seal_does_not_make_an_old_file(make_trainer, tmp_path, cut):
    path = tmp_path / 'a.pt'
    checkpoint.save_agent(path, make_trainer())
    path.write_bytes(path.read_bytes()[:-cut])
    with pytest.raises(CheckpointError, match=r'a.pt.*is damaged'):
        agent_file.load(path)


@pytest.mark.parametrize('write', [write_unsealed, write_without_policy])
@pytest.mark.parametrize('name', ['small_config', 'switched_config'])
def test_files_of_before_still_resume_and_act(make_trainer, tmp_path, request, write, name):
    trainer = make_trainer(config=request.getfixturevalue(name))
    advance(trainer, 2)
    write(tmp_path / 'old.pt', trainer)
    assert_same(checkpoint.load(tmp_path / 'old.pt'), trainer)
    seen = np.linspace(-1.0, 1.0, trainer.spec.size, dtype=np.float32)
    action = agent_file.load(tmp_path / 'old.pt').policy(seen)
    np.testing.assert_array_equal(action, trainer.learner.act(seen, explore=False))


def test_the_shipped_agent_loads():
    shipped = agent_file.load(AGENTS / 'ABCDE.pt')
    assert (shipped.spec.letters, shipped.episode) == ('ABCDE', 300)


def test_configuration_of_another_version_is_refused(make_trainer, tmp_path, monkeypatch):
    path = tmp_path / 'a.pt'
    trainer = make_trainer()
    content = trainer.config.to_mapping()
    content['learner']['ddpg']['momentum'] = 0.9
    monkeypatch.setattr(type(trainer.config), 'to_mapping', lambda config: content)
    checkpoint.save_agent(path, trainer)
    with pytest.raises(CheckpointError, match=r"a.pt.*cannot be used.*'learner.ddpg.momentum'"):
        agent_file.load(path)


def test_missing_and_foreign_files_are_refused(tmp_path):
    with pytest.raises(CheckpointError, match=r'no.pt.*not found'):
        agent_file.load(tmp_path / 'no.pt')
    torch.save({'weights': torch.zeros(1)}, tmp_path / 'other.pt')
    with pytest.raises(CheckpointError, match='expected format'):
        agent_file.load(tmp_path / 'other.pt')


class Payload:
    def __reduce__(self):
        return (exec, ('raise SystemExit("code ran")',))


def test_code_in_a_file_does_not_run(tmp_path):
    (tmp_path / 'evil.pt').write_bytes(pickle.dumps(Payload(), protocol=2))
    with pytest.raises(CheckpointError, match='cannot be read'):
        agent_file.load(tmp_path / 'evil.pt')
    torch.save({'format': Payload()}, tmp_path / 'evil2.pt')
    with pytest.raises(CheckpointError, match='cannot be read'):
        agent_file.load(tmp_path / 'evil2.pt')
