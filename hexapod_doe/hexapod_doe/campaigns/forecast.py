# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Says before a campaign starts how long it will take about; its pace tells better soon."""

from collections.abc import Sequence

from hexapod_agent.specification.run_spec import RunSpec

SECONDS_PER_STEP = 0.0037
"""Of a worker's processor per control period, with article.yaml on shared cores: docs/fleet.md."""
_WITHOUT_UPDATES = 0.1
"""Share of that which is not its update; a step of the evaluation is that alone."""
_RATIO = 'learner.ddpg.update_ratio'
_COSTLY = (
    'learner.algorithm', 'learner.actor.hidden', 'learner.critic.hidden', 'learner.critic.merge',
    'learner.ddpg.batch_size', 'learner.ddpg.update_every', 'training.precision', 'scene.',
)  # fmt: skip
"""What else decides the time of a step."""
_HOUR_S = 3600.0


def forecast(due: Sequence[RunSpec], workers: int) -> str:
    """Return how much there is to train, and how long that may take.

    Args:
        due: the specifications of the runs, all of one length.
        workers: side by side on this machine; 0 where they are elsewhere.
    """
    what = f'{len(due)} runs of {due[0].training.episodes} episodes to train'
    later = 'the first episodes will tell how long that takes'
    if not workers or not all(map(is_foretold, due)):
        return f'{what}; {later}'
    seconds = sum(map(seconds_of, due)) / min(workers, len(due))
    side = f'{min(workers, len(due))} at a time' if min(workers, len(due)) > 1 else 'one at a time'
    return (
        f'{what}, {side}: about {_rounded(seconds)}, judged by two cores of a shared EPYC host; '
        f'{later} here'
    )


def seconds_of(spec: RunSpec) -> float:
    """Return the time that a shared core takes for a run with its evaluation, s."""
    ratio = spec.value(_RATIO) / RunSpec.load().value(_RATIO)
    step = _WITHOUT_UPDATES + (1.0 - _WITHOUT_UPDATES) * ratio
    training = spec.training
    steps = training.episodes * step + training.evaluation * _WITHOUT_UPDATES
    return steps * spec.task.time_limit_steps * SECONDS_PER_STEP


def is_foretold(spec: RunSpec) -> bool:
    """Whether ground and learner are as article.yaml's: others take another time."""
    return not any(key.startswith(_COSTLY) for key in spec.differences(RunSpec.load()))


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
