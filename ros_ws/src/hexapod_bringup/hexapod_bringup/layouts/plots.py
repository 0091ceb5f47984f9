# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What there is to see of a run: plots by tabs, whatever program draws them."""

from collections.abc import Iterator
from dataclasses import dataclass

from hexapod_agent.learning import metrics
from hexapod_sim.robot import LEG_JOINTS, LEGS


@dataclass(frozen=True)
class Curve:
    """One number of a topic over time.

    Attributes:
        topic: relative name.
        label: in the legend.
        field: of the message, with dots down to the number or to an array.
        index: in the array, where it is one.
        joint: whose element of the array is meant, in a joint state.
    """

    topic: str
    label: str
    field: str
    index: int | None = None
    joint: str = ''


@dataclass(frozen=True)
class Plot:
    """Curves that share axes."""

    title: str
    curves: tuple[Curve, ...]


def _legs(topic: str, field: str) -> tuple[Curve, ...]:
    return tuple(Curve(topic, leg, field, index) for index, leg in enumerate(LEGS))


def _joints(joint: str) -> tuple[Curve, ...]:
    return tuple(Curve('joint_states', leg, 'position', joint=f'{leg}_{joint}') for leg in LEGS)


_TABS: dict[str, tuple[Plot, ...]] = {
    'task': (
        Plot('offset from the line (m)', (Curve('line_offset', 'offset', 'offset'),)),
        Plot('reward', (Curve('step_outcome', 'reward', 'reward'),)),
        Plot(
            'velocity of the body (m/s)',
            tuple(Curve('body/twist', axis, f'twist.linear.{axis}') for axis in 'xyz'),
        ),
        Plot('height (m)', (Curve('body/height', 'range finder', 'range'),)),
    ),
    'joints': tuple(Plot(f'{joint} angles (rad)', _joints(joint)) for joint in LEG_JOINTS),
    'gait': (
        Plot('oscillators, x', _legs('cpg/state', 'x')),
        Plot('hip gain asked (rad)', _legs('cpg/command', 'hip_gain')),
        Plot('feet on the floor', _legs('foot_contacts', 'contact')),
        Plot(
            'vertical foot forces (N)',
            tuple(Curve(f'foot_force/{leg}', leg, 'wrench.force.z') for leg in LEGS),
        ),
    ),
    'learning': (
        Plot(
            'return of the episodes',
            (
                Curve('episode_result', 'return', 'episode_return'),
                Curve('episode_result', 'average', 'average_return'),
            ),
        ),
    ),
}


def tabs() -> dict[str, tuple[Plot, ...]]:
    """Return the plots by tab, those of the learner's metrics among them."""
    return _TABS | {'learning': (*_TABS['learning'], *_metric_plots())}


def _metric_plots() -> Iterator[Plot]:
    curves: dict[str, list[Curve]] = {}
    for index, metric in enumerate(metrics.METRICS):
        if metric.plot:
            curve = Curve('episode_result', metric.name, 'metric_values', index)
            curves.setdefault(metric.plot, []).append(curve)
    return (Plot(title, tuple(of_plot)) for title, of_plot in curves.items())


def prefix(namespace: str) -> str:
    """Return what goes in front of the relative names of a namespace."""
    name = namespace.strip('/')
    return f'/{name}/' if name else '/'
