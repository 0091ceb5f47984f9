# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Six coupled Hopf oscillators, one per leg, integrated over one control period.

    dx_i = alpha (mu_i - r_i^2) x_i - omega_i y_i
    dy_i = beta  (mu_i - r_i^2) y_i + omega_i x_i + delta sum_{j != i} Delta_ji
    Delta_ji = y_j cos(theta_ji) - x_j sin(theta_ji),  theta_ji = phi_j - phi_i

The coupling is that of Wang, Cui, Sun and Gao (2021), doi 10.1177/17298814211044934. In the
gait's phases phi every Delta_ji equals y_i: the coupling then adds 5 delta y_i, which enlarges
the limit cycle a little (squared radius by about 5 delta / (alpha + beta)).

All functions take leading batch dimensions. Rows of a batch never influence one another's
rounding: each is multiplied as a column of its own, so a fleet repeats single robots bit by bit.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from types import MappingProxyType
from typing import Annotated, Any

import numpy as np
from annotated_types import Interval
from hexapod_sim.article import section

from hexapod_sim import robot

_LEGS = len(robot.LEGS)
_HALF_STEP_S = 0.5e-9 * robot.TARGET_PERIOD_NS
_PERIODS_KEPT = 2048  # three episodes of 15 s, in 3 MB


@dataclass(frozen=True)
class Gait:
    """A gait: the phase of each leg [rad] and the share of the cycle spent in stance."""

    phases: tuple[float, ...]
    duty_factor: float


def _phases(*cycles: float) -> tuple[float, ...]:
    """Return phases [rad] from shares of a cycle."""
    return tuple(2.0 * np.pi * cycle for cycle in cycles)


# Phases over lf lm lr rf rm rr; a leg with the larger phase swings earlier. In tetrapod and wave
# the swing runs from rear to front on each side, the right side following the left.
GAITS = MappingProxyType(
    {
        'tripod': Gait(_phases(0, 1 / 2, 0, 1 / 2, 0, 1 / 2), 1 / 2),
        'tetrapod': Gait(_phases(-2 / 3, -1 / 3, 0, 0, -2 / 3, -1 / 3), 2 / 3),
        'wave': Gait(_phases(-2 / 6, -1 / 6, 0, -5 / 6, -4 / 6, -3 / 6), 5 / 6),
    }
)


# Far from where RK4 at 5 ms loses the limit cycle: 2 alpha mu times the step stays below 2.8.
_Rate = Annotated[float, Interval(ge=0.0, le=100.0)]
_Steepness = Annotated[float, Interval(ge=0.0, le=1e3)]
_Phase = Annotated[float, Interval(ge=-10.0, le=10.0)]


@dataclass(frozen=True)
class HopfConfig:
    """Constants of the oscillator network; article.yaml has their values."""

    alpha: _Rate
    """Convergence rate of x towards the limit cycle [1/s per squared radius]."""
    beta: _Rate
    """Convergence rate of y towards the limit cycle [1/s per squared radius]."""
    coupling: _Rate
    """Strength delta of the coupling between legs [1/s]."""
    gait: str
    """Gait: tripod, tetrapod or wave."""
    swing_stance: bool
    """Let swing (y < 0) and stance take the gait's shares of the cycle, instead of half each."""
    sigmoid_gain: _Steepness
    """Steepness a of the change between swing and stance frequency."""
    start_phase: _Phase
    """Common phase at the start [rad]. A quarter cycle starts every hip at mid-stroke, so that
    the first half-stance does not turn the robot."""

    @classmethod
    def of_article(cls, **changes: Any) -> 'HopfConfig':
        """Return the oscillators of article.yaml, with some values changed."""
        return cls(**section('cpg', 'hopf') | changes)

    def __post_init__(self) -> None:
        if self.gait not in GAITS:
            raise ValueError(f'gait {self.gait!r}: expected one of {", ".join(GAITS)}')


def start_state(config: HopfConfig, batch: tuple[int, ...] = ()) -> tuple[np.ndarray, np.ndarray]:
    """Return x and y, each (*batch, 6), in the gait's phases on the unit limit cycle."""
    phase = np.array(GAITS[config.gait].phases) + config.start_phase
    shape = (*batch, _LEGS)
    return (
        np.broadcast_to(np.cos(phase), shape).copy(),
        np.broadcast_to(np.sin(phase), shape).copy(),
    )


def step(
    x: np.ndarray, y: np.ndarray, mu: np.ndarray, frequency: np.ndarray, config: HopfConfig
) -> tuple[np.ndarray, np.ndarray]:
    """Integrate one control period.

    Args:
        x: First state of each oscillator (..., 6).
        y: Second state (..., 6); y < 0 is swing.
        mu: Squared radius of the limit cycle (..., 6).
        frequency: Angular frequency (..., 6) [rad/s].
        config: Constants of the network.

    Returns:
        x and y at the end of the period, each (..., 6).
    """
    xs, ys = trajectory(x, y, mu, frequency, config)
    return xs[..., -1, :], ys[..., -1, :]


def trajectory(
    x: np.ndarray, y: np.ndarray, mu: np.ndarray, frequency: np.ndarray, config: HopfConfig
) -> tuple[np.ndarray, np.ndarray]:
    """Integrate one control period in SUBSTEPS classical Runge-Kutta steps.

    Arguments are those of ``step``.

    Returns:
        x and y at the end of every sub-step, each (..., SUBSTEPS, 6), not to be written to.
    """
    if x.ndim > 1:
        return _integrated(x, y, mu, frequency, config)
    arrays = (np.asarray(array, np.float64) for array in (x, y, mu, frequency))
    return _remembered(*(array.tobytes() for array in arrays), config)


@lru_cache(maxsize=_PERIODS_KEPT)
def _remembered(
    x: bytes, y: bytes, mu: bytes, frequency: bytes, config: HopfConfig
) -> tuple[np.ndarray, np.ndarray]:
    """Return a single robot's trajectory, which it may have gone through before.

    Where no action sets radius or frequency, every episode has the same oscillations, and
    integrating them takes as long as the physics.
    """
    x0, y0, radius, turn = (np.frombuffer(numbers) for numbers in (x, y, mu, frequency))
    parts = _integrated(x0, y0, radius, turn, config)
    for part in parts:
        part.flags.writeable = False
    return parts


def _integrated(
    x: np.ndarray, y: np.ndarray, mu: np.ndarray, frequency: np.ndarray, config: HopfConfig
) -> tuple[np.ndarray, np.ndarray]:
    """Compute what `trajectory` returns."""
    # The state is one column per robot, x above y: (..., 12, 1).
    state = np.concatenate((x, y), axis=-1)[..., None]
    flow = _flow(mu, frequency, config)
    states = np.empty((*state.shape[:-2], robot.SUBSTEPS, 2 * _LEGS))
    for substep in range(robot.SUBSTEPS):
        # Half-step increments: k is (h / 2) times the derivative.
        k1 = flow(state)
        k2 = flow(state + k1)
        k3 = flow(state + k2)
        k3 += k3
        k4 = flow(state + k3)
        # state + h / 6 (k1 + 2 k2 + 2 k3 + k4) in terms of the increments; k3 is doubled already.
        k4 += k1
        k4 += k2
        k4 += k2
        k4 += k3
        k4 /= 3.0
        state = state + k4
        states[..., substep, :] = state[..., 0]
    return states[..., :_LEGS], states[..., _LEGS:]


def _flow(
    mu: np.ndarray, frequency: np.ndarray, config: HopfConfig
) -> Callable[[np.ndarray], np.ndarray]:
    """Return the function from a state (..., 12, 1) to its increment over half a sub-step.

    The network is a linear part less a cubic part: increment = linear s - (damping s^2) s.
    """
    coupling, damping, rates = _matrices(config)
    linear = np.empty((*mu.shape[:-1], 2 * _LEGS, 2 * _LEGS))
    linear[...] = coupling
    # Three diagonals of the 12 x 12 matrix as strided views: growth, and the rotation.
    flat = linear.reshape(*mu.shape[:-1], -1)
    flat[..., ::13] += rates * np.concatenate((mu, mu), axis=-1)
    angle = _HALF_STEP_S * frequency
    if not config.swing_stance:
        flat[..., 6:78:13] -= angle
        flat[..., 72::13] += angle

    linear_times, damping_times = (_times(m, linear.ndim > 2) for m in (linear, damping))

    def flow(state: np.ndarray) -> np.ndarray:
        cubic = damping_times(state * state)
        cubic *= state
        increment = linear_times(state)
        increment -= cubic
        return increment

    def swing_stance_flow(state: np.ndarray) -> np.ndarray:
        x, y = state[..., :_LEGS, :], state[..., _LEGS:, :]
        turn = angle[..., None] * _speed_ratio(y, config)
        return flow(state) + np.concatenate((-turn * y, turn * x), axis=-2)

    return swing_stance_flow if config.swing_stance else flow


def _times(matrix: np.ndarray, batched: bool) -> Callable[[np.ndarray], np.ndarray]:
    """Return the product of a matrix and columns (..., 12, 1).

    For a single robot `dot` does what `matmul` does for each robot of a batch, to the last bit,
    at a third of its overhead.
    """
    return partial(np.matmul, matrix) if batched else matrix.dot


def _speed_ratio(y: np.ndarray, config: HopfConfig) -> np.ndarray:
    """Return the angular speed over its mean: one value in stance (y > 0), another in swing.

    omega = omega_st / (exp(-a y) + 1) + omega_sw / (exp(a y) + 1), with
    omega_st = pi / (duty T) and omega_sw = pi / ((1 - duty) T).
    """
    duty = GAITS[config.gait].duty_factor
    stance = 1.0 / (np.exp(-config.sigmoid_gain * y) + 1.0)
    return stance / (2.0 * duty) + (1.0 - stance) / (2.0 * (1.0 - duty))


@lru_cache(maxsize=16)
def _matrices(config: HopfConfig) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the constant coupling and damping (12, 12) and rates (12,), times half a sub-step."""
    phases = np.array(GAITS[config.gait].phases)
    theta = phases[None, :] - phases[:, None]  # theta[i, j] = phi_j - phi_i
    others = config.coupling * _HALF_STEP_S * (1.0 - np.eye(_LEGS))
    coupling = np.zeros((2 * _LEGS, 2 * _LEGS))
    coupling[_LEGS:, :_LEGS] = -others * np.sin(theta)
    coupling[_LEGS:, _LEGS:] = others * np.cos(theta)
    rates = _HALF_STEP_S * np.repeat((config.alpha, config.beta), _LEGS)
    # Row i of damping times the squared state is rate_i (x_i^2 + y_i^2).
    damping = rates[:, None] * np.tile(np.eye(_LEGS), (2, 2))
    return coupling, damping, rates
