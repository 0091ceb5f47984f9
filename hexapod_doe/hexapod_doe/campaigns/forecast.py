# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Says before a campaign starts how long it will take about; its pace tells better soon."""

from __future__ import annotations

from hexapod_agent.specification.run_spec import RunSpec

from hexapod_doe.bags.run_identity import odd_runs
from hexapod_doe.campaigns.campaign import shared_settings

SECONDS_PER_STEP = 0.0037
"""Of a worker's processor per control period, with article.yaml on shared cores: docs/fleet.md."""
_ELSE = ('evaluation', 'config.task', 'config.cpg', 'config.learner.noise', 'config.training')
"""Sections of the configuration that hardly change the time of a step."""
_HOUR_S = 3600.0


def forecast(due: int, episodes: int, workers: int, config: RunSpec | None) -> str:
    """Return how much there is to train, and how long that may take.

    Args:
        due: runs.
        episodes: of each run.
        workers: side by side on this machine; 0 where they are elsewhere.
        config: of the runs, if it is known.
    """
    what = f'{due} runs of {episodes} episodes to train'
    later = 'the first episodes will tell how long that takes'
    if not workers or config is None or not _as_measured(config):
        return f'{what}; {later}'
    steps = due * episodes * config.task.time_limit_steps
    seconds = steps * SECONDS_PER_STEP / min(workers, due)
    side = f'{min(workers, due)} at a time' if min(workers, due) > 1 else 'one at a time'
    return (
        f'{what}, {side}: about {_rounded(seconds)}, judged by two cores of a shared EPYC host; '
        f'{later} here'
    )


def _as_measured(config: RunSpec) -> bool:
    """Whether the learner is article.yaml's: another one takes another time."""
    odd = odd_runs({'found': _shared(config), 'expected': _shared(RunSpec.load())})
    return all(key.startswith(_ELSE) for key in odd)


def _shared(config: RunSpec) -> dict[str, str]:
    return shared_settings(config, 1)


def _rounded(seconds: float) -> str:
    """Return a time as the rough figure that it is."""
    hours = seconds / _HOUR_S
    return (
        f'{hours:.0f} h'
        if hours >= 10
        else f'{hours:.1f} h'
        if hours >= 1
        else (f'{max(1, round(seconds / 60))} min')
    )
