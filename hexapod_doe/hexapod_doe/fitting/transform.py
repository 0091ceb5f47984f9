# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Power transforms of the response: Box-Cox with λ profiled given the model, and the way back.

`scipy.stats.boxcox` maximises the marginal likelihood, which answers another question (λ 1.50
instead of 2.65 on a two-level campaign); here each λ is judged by the residuals of the model.
Box and Cox, J. R. Stat. Soc. B 26 (1964).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import linalg, optimize, special, stats

from hexapod_doe.errors import AnalysisError

BOUNDS = (-5.0, 5.0)
SHIFT_MARGIN = 0.05
SENSITIVITY_MARGINS = (0.001, 0.01, 0.05, 0.1, 0.25, 0.5, 1.0)


@dataclass(frozen=True)
class ShiftSensitivity:
    """What λ would be under another shift: with negative rewards λ alone means little."""

    margin: float
    shift: float
    lambda_hat: float


@dataclass(frozen=True)
class Transform:
    """y ↦ g + (z^λ − g^λ)/(λ·g^(λ−1)), or g + g·ln(z/g) for λ = 0; z = y + shift.

    g is the geometric mean of z: near it the transformed response keeps its unit and its digits,
    whatever λ is.
    """

    kind: str
    """`log`, `boxcox` or `power`."""
    lambda_: float
    shift: float
    shift_rule: str
    scale: float = 1.0
    """g, the geometric mean of the shifted response of the fitted rows."""
    lambda_hat: float | None = None
    """Where the likelihood is highest; λ is this rounded to a half."""
    lambda_ci: tuple[float, float] | None = None
    """95 % interval of λ by the profile likelihood."""
    sensitivity: tuple[ShiftSensitivity, ...] = ()

    def forward(self, response: np.ndarray) -> np.ndarray:
        """Return the transformed response."""
        ratio = (np.asarray(response, float) + self.shift) / self.scale
        with np.errstate(over='ignore'):
            return self.scale * (1 + special.boxcox(ratio, self.lambda_))

    def inverse(self, transformed: np.ndarray) -> np.ndarray:
        """Return original units; NaN below the transform's domain, where no response leads."""
        eta = np.asarray(transformed, float) / self.scale - 1
        if self.lambda_ == 0:
            return self.scale * np.exp(eta) - self.shift
        with np.errstate(invalid='ignore', divide='ignore', over='ignore'):
            ratio = np.where(self._base(eta) > 0, special.inv_boxcox(eta, self.lambda_), np.nan)
        return self.scale * ratio - self.shift

    def slope(self, transformed: np.ndarray) -> np.ndarray:
        """Return g'(η) of the way back, by which the delta method scales a standard error."""
        eta = np.asarray(transformed, float) / self.scale - 1
        if self.lambda_ == 0:
            return np.exp(eta)
        return self._base(eta) ** (1 / self.lambda_ - 1)

    def mean(self, transformed: np.ndarray, s: float) -> np.ndarray:
        """Return the mean in original units, to second order: g(η) + g''(η)s²/2."""
        eta, s = np.asarray(transformed, float) / self.scale - 1, s / self.scale
        if self.lambda_ == 0:
            return self.scale * np.exp(eta + s**2 / 2) - self.shift
        second = (1 - self.lambda_) * self._base(eta) ** (1 / self.lambda_ - 2)
        return self.inverse(transformed) + self.scale * second * s**2 / 2

    def _base(self, eta: np.ndarray) -> np.ndarray:
        return self.lambda_ * eta + 1


def shift_for(response: np.ndarray, margin: float = SHIFT_MARGIN) -> float:
    """Return what makes the response positive: 0 if it is, else −min + margin·range.

    The shift is never estimated by likelihood, which has no bound as the shift nears −min.
    """
    low, high = float(np.min(response)), float(np.max(response))
    return 0.0 if low > 0 else -low + margin * (high - low)


def profile(response: np.ndarray, matrix: np.ndarray) -> Callable[[float], float]:
    """Return the log-likelihood of λ given the model, for a positive response (n,).

    −N/2·ln(SSE(λ)/N) with y(λ) = (y^λ − 1)/(λ·g^(λ−1)), g the geometric mean.
    """
    q = linalg.qr(matrix, mode='economic')[0]
    geometric_mean = _geometric_mean(response)
    scaled = response / geometric_mean

    def log_likelihood(power: float) -> float:
        y = geometric_mean * special.boxcox(scaled, power)
        residuals = y - q @ (q.T @ y)
        return float(-len(y) / 2 * np.log(residuals @ residuals / len(y)))

    return log_likelihood


def _geometric_mean(response: np.ndarray) -> float:
    return float(np.exp(np.log(response).mean()))


def profile_lambda(response: np.ndarray, matrix: np.ndarray) -> float:
    """Return the λ of the highest likelihood within `BOUNDS`."""
    log_likelihood = profile(response, matrix)
    found = optimize.minimize_scalar(
        lambda power: -log_likelihood(power),
        bounds=BOUNDS,
        method='bounded',
        options={'xatol': 1e-10},
    )
    return float(found.x)


def profile_interval(
    response: np.ndarray, matrix: np.ndarray, lambda_hat: float, confidence: float = 0.95
) -> tuple[float, float]:
    """Return where the log-likelihood is within χ²₁/2 of its maximum, cut at `BOUNDS`."""
    log_likelihood = profile(response, matrix)
    limit = log_likelihood(lambda_hat) - stats.chi2.ppf(confidence, 1) / 2

    def crossing(bound: float) -> float:
        if log_likelihood(bound) >= limit:
            return bound
        return float(optimize.brentq(lambda x: log_likelihood(x) - limit, lambda_hat, bound))

    return crossing(BOUNDS[0]), crossing(BOUNDS[1])


def choose_transform(text: str, response: np.ndarray, matrix: np.ndarray) -> Transform | None:
    """Return the transform that `none`, `log`, `boxcox` or `power:L` names for these rows.

    Args:
        text: The name.
        response: Response of the rows that are fitted (n,).
        matrix: Their model matrix (n, p), with fewer terms than rows.

    Raises:
        AnalysisError: The name is unknown, or the model leaves Box-Cox no error to judge λ by.
    """
    kind, _, value = text.partition(':')
    if kind == 'none':
        return None
    shift = shift_for(response)
    rule = (
        '0: every response is positive'
        if shift == 0
        else f'-min + {SHIFT_MARGIN:g}·(max - min) of the fitted rows'
    )
    scale = _geometric_mean(response + shift)
    if kind == 'log':
        return _checked(Transform(kind, 0.0, shift, rule, scale), response)
    if kind == 'power':
        return _checked(Transform(kind, _power(text, value), shift, rule, scale), response)
    if kind != 'boxcox':
        raise AnalysisError(f'transform {text!r}: expected none, log, boxcox or power:L')
    return _checked(_boxcox(Transform(kind, 1.0, shift, rule, scale), response, matrix), response)


def _power(text: str, value: str) -> float:
    try:
        power = float(value)
    except ValueError:
        power = np.nan
    if not np.isfinite(power):
        raise AnalysisError(f'transform {text!r}: expected a number after power:')
    return power


def _checked(transform: Transform, response: np.ndarray) -> Transform:
    """Return the transform, if different responses stay different under it."""
    values = transform.forward(response)
    if not np.isfinite(values).all() or np.unique(values).size < np.unique(response).size:
        raise AnalysisError(
            f'power {transform.lambda_:g} of responses from {response.min():g} to '
            f'{response.max():g} is beyond the digits of floating point numbers: choose a power '
            'nearer to 1'
        )
    return transform


def _boxcox(blank: Transform, response: np.ndarray, matrix: np.ndarray) -> Transform:
    if matrix.shape[0] <= matrix.shape[1]:
        raise AnalysisError('Box-Cox needs a model with degrees of freedom for error')
    positive = response + blank.shift
    best = profile_lambda(positive, matrix)
    return replace(
        blank,
        lambda_=float(np.round(2 * best) / 2),
        lambda_hat=best,
        lambda_ci=profile_interval(positive, matrix, best),
        sensitivity=() if blank.shift == 0 else _sensitivity(response, matrix),
    )


def _sensitivity(response: np.ndarray, matrix: np.ndarray) -> tuple[ShiftSensitivity, ...]:
    shifts: Sequence[tuple[float, float]] = [
        (margin, shift_for(response, margin)) for margin in SENSITIVITY_MARGINS
    ]
    return tuple(
        ShiftSensitivity(margin, shift, profile_lambda(response + shift, matrix))
        for margin, shift in shifts
    )
