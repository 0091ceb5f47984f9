# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What decides the results of a run, as its bag states it: the one place that compares runs.

A bag is that of a row if sensors, seed, length and configuration are the row's. Runs belong to
one experiment if length and configuration are the same; what they were made with, such as the
version of a library, changes their results in the last bits and is told.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from functools import lru_cache
from types import MappingProxyType
from typing import Any

import yaml
from hexapod_agent.specification.run_spec import ConfigError, RunSpec

from hexapod_doe.bags.run_bag import EVALUATION

CONFIG = 'config'  # where a bag's specification stood before it had the sensors in it
SPEC = 'spec'
EPISODES = 'episodes'
_MAKING = ('machine', 'processor', 'device', 'git_commit')
_VERSION = 'version.'
_COMPARED_APART = (
    'config.observations.',
    'config.training.episodes',
    'config.training.evaluation',
    'config.training.checkpoint_every',
)
"""Sensors, length and evaluation are compared as such; a run gives the same wherever its
checkpoints are."""
_NAMED_KEYS, _NAMED_RUNS = 3, 8
"""How many of them a message names."""


def run_identity(metadata: Mapping[str, str]) -> dict[str, str]:
    """Return what decides a run: sensors, seed, and what `settings` returns, as far as stated."""
    found = settings(metadata)
    if 'observations' in metadata:
        found['observations'] = ''.join(sorted(metadata['observations'])) or 'none'
    if 'seed' in metadata:
        found['seed'] = metadata['seed']
    return found


def settings(metadata: Mapping[str, str]) -> dict[str, str]:
    """Return what all runs of an experiment share: length, and each value of their config.

    Bags of before do not state that they have no evaluation: the response tells them apart.
    """
    found = {key: metadata[key] for key in (EPISODES, EVALUATION) if key in metadata}
    text = metadata.get(SPEC, metadata.get(CONFIG))
    return found if text is None else found | dict(_flat_spec(text))


def spec_settings(spec: RunSpec) -> dict[str, str]:
    """Return what `settings` returns of the bag of a run of this specification."""
    training = spec.training
    lengths = {EPISODES: str(training.episodes), EVALUATION: str(training.evaluation)}
    return lengths | spec_values(spec.to_mapping())


def spec_key(key: str) -> str:
    """Return the name of a key of the specification among the settings of a run."""
    return f'{CONFIG}.{key}'


def making(metadata: Mapping[str, str]) -> dict[str, str]:
    """Return what a run was made with: versions, machine and commit."""
    return {k: v for k, v in metadata.items() if k in _MAKING or k.startswith(_VERSION)}


def differences(found: Mapping[str, str], expected: Mapping[str, str]) -> str:
    """Return in words how a run differs from what was expected; empty where it does not.

    What one side does not state at all is not compared.
    """
    odd = [
        f'{key} {found.get(key, "none")}, expected {expected.get(key, "none")}'
        for key in dict.fromkeys((*expected, *found))
        if found.get(key) != expected.get(key) and _stated(key, found) and _stated(key, expected)
    ]
    more = [f'and {len(odd) - _NAMED_KEYS} more'] if len(odd) > _NAMED_KEYS else []
    return '; '.join([*odd[:_NAMED_KEYS], *more])


def plan_differences(found: Mapping[str, str], expected: Mapping[str, str]) -> str:
    """Return how a run differs from what is known of it, as `differences`, if that is not all."""
    return differences({k: v for k, v in found.items() if k in expected}, expected)


def odd_runs(runs: Mapping[str, Mapping[str, str]], without: Sequence[str] = ()) -> dict[str, str]:
    """Return where runs differ among themselves: by key, which of them have which value.

    Args:
        runs: identity, or part of it, by run id.
        without: keys that may differ; `config` stands for all of the configuration.
    """
    keys = dict.fromkeys(key for found in runs.values() for key in found)
    texts = {}
    for key in keys:
        if key in without or key.split('.')[0] in without:
            continue
        values = {
            run: found.get(key, 'none') for run, found in runs.items() if _stated(key, found)
        }
        if len(set(values.values())) > 1:
            texts[key] = _shares(key, values)
    return texts


def _shares(key: str, values: Mapping[str, str]) -> str:
    """Say which runs have which value of a key: the odd ones by name, most of them by number."""
    (usual, count), *others = Counter(values.values()).most_common()
    parts = [
        f'{odd} in {_names([run for run, value in values.items() if value == odd])}'
        for odd, _ in others
    ]
    return f'{key} {"; ".join(parts)}; {usual} in the other {count}'


def _names(runs: Sequence[str]) -> str:
    more = f' and {len(runs) - _NAMED_RUNS} more' if len(runs) > _NAMED_RUNS else ''
    return ', '.join(runs[:_NAMED_RUNS]) + more


def _stated(key: str, found: Mapping[str, str]) -> bool:
    """Whether a value is known; a configuration is stated as a whole.

    But for a section of the learner of which a run has nothing: its algorithm, which is compared
    as such, has no such section.
    """
    parts = key.split('.')
    if parts[0] != CONFIG:
        return key in found
    section = '.'.join(parts[:3] if parts[1:2] == ['learner'] and len(parts) > 3 else parts[:1])
    return any(each == section or each.startswith(f'{section}.') for each in found)


@lru_cache(maxsize=256)
def _flat_spec(text: str) -> Mapping[str, str]:
    """Return each value of a specification by its dotted key, filled up from article.yaml.

    An older version's lacks keys that this one has; one that this version cannot read is taken
    as it stands.
    """
    try:
        values: Any = yaml.safe_load(text) or {}
        values = RunSpec.from_mapping(values, 'bag').to_mapping()
    except yaml.YAMLError:
        values = text
    except ConfigError:
        pass
    return MappingProxyType(spec_values(values))


def spec_values(values: Any) -> dict[str, str]:
    """Return values of a specification, nested or by dotted keys, as `settings` has them."""
    return {k: v for k, v in _flattened(values, CONFIG) if not k.startswith(_COMPARED_APART)}


def _flattened(values: Any, key: str) -> list[tuple[str, str]]:
    if isinstance(values, Mapping) and values:
        return [
            pair for name, value in values.items() for pair in _flattened(value, f'{key}.{name}')
        ]
    if isinstance(values, (list, tuple)):
        values = list(values)
    return [(key, str(values))]
