# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Says before a campaign starts how long it will take about; its pace tells better soon."""

from collections.abc import Sequence

from hexapod_agent.specification.run_spec import RunSpec

SECONDS_PER_STEP = 0.0037
"""Of a worker's processor per control period, with article.yaml on shared cores: docs/fleet.md."""
_ELSE = ('observations.', 'sensors.', 'task.', 'cpg.', 'learner.noise.', 'training.')
"""What hardly changes the time of a step."""
_HOUR_S = 3600.0


def forecast(due: Sequence[RunSpec], workers: int) -> str:
    """Return how much there is to train, and how long that may take.

    Args:
        due: the specifications of the runs, all of one length.
        workers: side by side on this machine; 0 where they are elsewhere.
    """
    what = f'{len(due)} runs of {due[0].training.episodes} episodes to train'
    later = 'the first episodes will tell how long that takes'
    if not workers or not all(map(_as_measured, due)):
        return f'{what}; {later}'
    steps = sum(spec.training.episodes * spec.task.time_limit_steps for spec in due)
    seconds = steps * SECONDS_PER_STEP / min(workers, len(due))
    side = f'{min(workers, len(due))} at a time' if min(workers, len(due)) > 1 else 'one at a time'
    return (
        f'{what}, {side}: about {_rounded(seconds)}, judged by two cores of a shared EPYC host; '
        f'{later} here'
    )


def _as_measured(spec: RunSpec) -> bool:
    """Whether the learner is article.yaml's: another one takes another time."""
    return all(key.startswith(_ELSE) for key in spec.differences(RunSpec.load()))


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
