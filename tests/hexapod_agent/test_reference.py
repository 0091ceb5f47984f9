# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Trainings give the numbers that they gave at commit 07dd037, whatever was rebuilt since.

With the recorded libraries and kind of processor, to the last bit. Elsewhere products of matrices
are summed in another order, and after the first episode two such trainings have little in common:
there the first episode counts. Its tolerances are four times and more what the instructions of
AVX2 instead of AVX-512 change (return 0.25 %, critic's loss 8 %, actor's 5e-6, mean Q 2e-5).

`python tests/hexapod_agent/test_reference.py FILE COMMIT` records the numbers of today's code.
"""

import csv
import hashlib
import json
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
from hexapod_agent.learning import checkpoint
from hexapod_agent.learning.provenance import provenance
from torch import Tensor

from hexapod_agent import train

RECORDED = Path(__file__).parents[1] / 'data' / 'reference_07dd037.json'
SETS = ('', 'CE', 'ABCDE')
SEED = 1
LENGTHS = (2, 5)
"""Episodes after which weights are kept."""
FIGURES = ('steps', 'episode_return', 'critic_loss', 'actor_loss', 'mean_q', 'saturated_share')
ENTRIES = ('version.numpy', 'version.torch', 'version.mujoco', 'processor')
"""What the last bit of a training depends on, by its name in `provenance`."""
TOLERANCES = {'episode_return': 1e-2, 'critic_loss': 0.4, 'actor_loss': 1e-4, 'mean_q': 1e-3}


def made_with() -> dict[str, str]:
    return {entry: provenance()[entry] for entry in ENTRIES}


def trained(observations: str, lengths: Sequence[int]) -> dict[str, Any]:
    """Train a set from seed `SEED`; return its figures by episode, and digests of its weights.

    Args:
        observations: The set.
        lengths: Numbers of episodes after which the weights count; from each the run is resumed.
    """
    weights = {}
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / 'run'
        options = {'observations': observations, 'seed': SEED, 'out': out}
        start = [f'--{name}={value}' for name, value in options.items()]
        start.append('--set=training.evaluation=0')  # no part of what was recorded
        for length in lengths:
            train.main([*start, f'--episodes={length}', *(['--resume'] if weights else [])])
            networks = checkpoint.load(out / train.CHECKPOINT).learner.networks
            weights[str(length)] = {
                'actor': digest(networks.actor_parameters.arrays),
                'critic': digest(networks.critic_parameters.arrays),
            }
        with (out / train.LOG).open(newline='') as file:
            rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in FIGURES} | {'weights': weights}


def digest(arrays: Mapping[str, Tensor]) -> str:
    """Return the SHA-256 of a network's arrays, in the order of their names."""
    content = hashlib.sha256()
    for name in sorted(arrays):
        content.update(arrays[name].contiguous().numpy().tobytes())
    return content.hexdigest()


def check(observations: str, lengths: tuple[int, ...]) -> None:
    recorded = json.loads(RECORDED.read_text(encoding='utf-8'))
    found, expected = trained(observations, lengths), recorded['sets'][observations]
    if made_with() == recorded['made_with']:
        assert found['weights'] == {
            str(length): expected['weights'][str(length)] for length in lengths
        }
        for name in FIGURES:
            assert found[name] == expected[name][: lengths[-1]], name
        return
    for name, tolerance in TOLERANCES.items():
        assert found[name][0] == pytest.approx(expected[name][0], rel=tolerance), name


def test_short_training_is_the_recorded_one() -> None:
    check('ABCDE', (2,))


@pytest.mark.slow
@pytest.mark.parametrize('observations', SETS)
def test_training_is_the_recorded_one(observations) -> None:
    check(observations, LENGTHS)


def record(path: Path, commit: str) -> None:
    """Write the numbers of today's code."""
    sets = {observations: trained(observations, LENGTHS) for observations in SETS}
    content = {'commit': commit, 'seed': SEED, 'made_with': made_with(), 'sets': sets}
    path.write_text(json.dumps(content, indent=1) + '\n', encoding='utf-8')


if __name__ == '__main__':
    record(Path(sys.argv[1]), sys.argv[2])
