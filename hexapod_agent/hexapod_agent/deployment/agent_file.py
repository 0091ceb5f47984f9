# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Files of trained agents: specification, layout of what goes in and out, and policy.

A file is a torch archive of tensors, numbers and text under a seal (`sealed_file`), and is read
without running code. What is not to the last bit what was written is refused. A checkpoint of a
run is such a file with the run's state in it. Files of before the seal are held to the checksums
of their archive, which do not cover all of it.
"""

import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import torch
from hexapod_cpg.mapping import ACTION_SIZE
from hexapod_sim.robot import LEGS

from hexapod_agent.algorithms.policies import MlpPolicy
from hexapod_agent.deployment.sealed_file import Seal, read_seal, write_sealed
from hexapod_agent.specification.observation import ObservationSpec
from hexapod_agent.specification.run_spec import RunSpec

FORMAT = 'hexapod-agent-3'
_WITHOUT_POLICY = 'hexapod-checkpoint-2'  # but for the actor in the state of its learner
_UNSEALED = 'hexapod-checkpoint-1'


class CheckpointError(ValueError):
    """A file is no usable agent or checkpoint, or cannot become one; the text names it."""


@dataclass(frozen=True)
class TrainedAgent:
    """An agent apart from the run that trained it.

    Attributes:
        config: The run's specification.
        seed: Its seed.
        episode: Episodes that it had been trained for.
        policy: From observation to action.
    """

    config: RunSpec
    seed: int
    episode: int
    policy: MlpPolicy

    @property
    def spec(self) -> ObservationSpec:
        """What it observes."""
        return self.config.observed

    def save(self, path: str | Path, state: Mapping[str, Any] | None = None) -> None:
        """Write a file, with the state of its run if it is to go on; a crash leaves the old one.

        Raises:
            CheckpointError: It cannot be written; the one before is still there.
        """
        content = {
            'format': FORMAT,
            'spec': self.config.to_mapping(),
            'layout': _layout(self.spec),
            'seed': self.seed,
            'episode': self.episode,
            'policy': _converted(self.policy.to_mapping(), np.ndarray, torch.from_numpy),
        } | ({} if state is None else {'state': state})
        try:
            write_sealed(Path(path), partial(torch.save, content))
        except (OSError, RuntimeError) as error:  # torch has its own way to say the disk is full
            raise CheckpointError(
                f'checkpoint {str(path)!r}: cannot be written: {error}'
            ) from error


def load(path: str | Path) -> TrainedAgent:
    """Read an agent's file, or the agent of a run's checkpoint.

    Raises:
        CheckpointError: The file is missing, damaged, something else, or of a specification or a
            sensor table that this version does not know.
    """
    agent, _ = load_with_state(path)
    return agent


def load_with_state(path: str | Path) -> tuple[TrainedAgent, Mapping[str, Any] | None]:
    """Read an agent and the state of its run, None without one; raises as `load` does."""
    content = _read(Path(path).expanduser())
    try:
        config = _spec(content)
        state = content.get('state')
        if 'policy' not in content:
            return _agent_of_before(config, content), _state_of_before(content['state'])
        if content['layout'] != (expected := _layout(config.observed)):
            raise ValueError(f'made for {content["layout"]}, expected {expected}')
        policy = _converted(content['policy'], torch.Tensor, torch.Tensor.numpy)
        agent = TrainedAgent(
            config, content['seed'], content['episode'], MlpPolicy.from_mapping(policy)
        )
    except Exception as error:  # of another version, or whatever a file without a seal may hold
        raise CheckpointError(
            f'checkpoint {str(path)!r} cannot be used: {reason(error)}'
        ) from error
    return agent, state


def _layout(spec: ObservationSpec) -> dict[str, Any]:
    """Return what the numbers of observation and action are, in their order."""
    return {
        'observation': spec.sizes,
        'action': {'legs': list(LEGS), 'size': ACTION_SIZE},
    }


def _converted(value: Any, kind: type, convert: Any) -> Any:
    """Return nested values with those of one kind converted."""
    if isinstance(value, dict):
        return {key: _converted(each, kind, convert) for key, each in value.items()}
    if isinstance(value, list):
        return [_converted(each, kind, convert) for each in value]
    return convert(value) if isinstance(value, kind) else value


def _spec(content: Mapping[str, Any]) -> RunSpec:
    """Return the run's specification; files of before there was one have it in two parts."""
    if 'spec' in content:
        return RunSpec.from_mapping(content['spec'], 'its specification')
    config = RunSpec.from_mapping(content['config'], 'its configuration')
    return config.observing(content['observations'])


def _agent_of_before(config: RunSpec, content: Mapping[str, Any]) -> TrainedAgent:
    """Return the agent of a file without a policy: what acts is in the state of its learner."""
    from hexapod_agent.algorithms.ddpg.learner import policy_of_before

    state, size = content['state'], config.observed.size
    policy = policy_of_before(config.learner, size, ACTION_SIZE, state['agent'])
    return TrainedAgent(config, content['seed'], state['episode'], policy)


def _state_of_before(state: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """Return a run's state as it is now, of a file that has its learner's beside it."""
    return dict(state) | {'learner': state} if 'replay' in state else None


def _read(path: Path) -> Mapping[str, Any]:
    """Unpack the archive and check that it is a whole one of ours."""
    if not path.is_file():
        raise CheckpointError(f'checkpoint {str(path)!r} not found, expected a file of `train`')
    try:
        seal = read_seal(path)
        if seal is Seal.ABSENT:
            _check_archive(path)
        content = torch.load(path, weights_only=True) if seal is not Seal.BROKEN else {}
    except Exception as error:  # torch raises whatever damaged bytes lead it to
        raise CheckpointError(
            f'checkpoint {str(path)!r} cannot be read, expected a whole file of `train`: '
            f'{reason(error)}'
        ) from error
    found = content.get('format') if isinstance(content, dict) else None
    if seal is Seal.BROKEN or (seal is Seal.ABSENT and found in (FORMAT, _WITHOUT_POLICY)):
        raise CheckpointError(
            f'checkpoint {str(path)!r} is damaged: it is not what was written, by its SHA-256; '
            'expected a whole file of `train`'
        )
    if found not in ((_UNSEALED,) if seal is Seal.ABSENT else (FORMAT, _WITHOUT_POLICY)):
        raise CheckpointError(f'checkpoint {str(path)!r}: expected format {FORMAT!r}')
    return content


def _check_archive(path: Path) -> None:
    """Hold a file without a seal to the checksums of its archive.

    Raises:
        zipfile.BadZipFile: One differs, or it is no archive.
    """
    with zipfile.ZipFile(path) as archive:
        damaged = archive.testzip()
    if damaged is not None:
        raise zipfile.BadZipFile(f'the checksum of {damaged} differs')


def reason(error: Exception) -> str:
    """Return what an error says, in one line; torch fills pages."""
    return (str(error).strip() or type(error).__name__).splitlines()[0]
