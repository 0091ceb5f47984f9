# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a device adds to the truth: bias, noise and quantisation of one reading, from a seed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexapod_sim.channel import Kind

_MOST_NUMBERS = 18  # of one reading: the joints
_MOST_STEPS = 2.0**52
# A unit quaternion has a number of at least this size, so that its rounding is not zero.
_COARSEST_ORIENTATION = 0.5


@dataclass(frozen=True)
class Distortion:
    """Errors of a reading, in its unit; of an orientation, as rotation about the body's axes."""

    noise: float = 0.0
    """Standard deviation of the error of each sample. Of a switch: chance to read the opposite."""
    bias: float = 0.0
    """Standard deviation of the error that is constant, drawn once for each number."""
    step: float = 0.0
    """Distance of the values that the device can give; 0 for any value."""

    def __post_init__(self) -> None:
        """Refuse what is negative or not a number."""
        for name, value in vars(self).items():
            if not 0.0 <= value < np.inf:
                raise ValueError(f'{name} {value}: expected a number that is not negative')

    @property
    def exact(self) -> bool:
        """Whether readings pass unchanged."""
        return not (self.noise or self.bias or self.step)


class Degradation:
    """One device's reading: the same seed and stamp give the same error, whatever came between.

    The generator is Philox, whose stream is addressed by a counter (Salmon et al. 2011, "Parallel
    random numbers: as easy as 1, 2, 3").
    """

    def __init__(self, distortion: Distortion, kind: Kind, seed: int, stream: int = 0) -> None:
        """Draw the constant error.

        Args:
            distortion: how large the errors are.
            kind: what they do to the numbers.
            seed: of all that is random.
            stream: tells apart readings that share a seed.

        Raises:
            ValueError: the steps of an orientation are too coarse to be one.
        """
        if kind == 'quaternion' and distortion.step > _COARSEST_ORIENTATION:
            raise ValueError(
                f'step {distortion.step}: expected at most {_COARSEST_ORIENTATION} for an '
                'orientation'
            )
        self._distortion = distortion
        self._kind = kind
        self._key = np.array([seed, stream], dtype=np.uint64)
        # The constant error is that of a time that no sample has.
        constant = self._generator(0, constant=True).standard_normal(_MOST_NUMBERS)
        self._bias = distortion.bias * constant

    def apply(self, values: NDArray[np.float64], stamp_ns: int) -> NDArray[np.float64]:
        """Return what the device reads where the truth is `values`.

        Args:
            values: (n,), or (4,) x y z w of an orientation, or switches (n,) of 0 and 1.
            stamp_ns: time of the sample.
        """
        if self._distortion.exact:
            return values
        if self._kind == 'switch':
            flipped = self._generator(stamp_ns).random(values.size) < self._distortion.noise
            return np.where(flipped, 1.0 - values, values)
        if self._kind == 'quaternion':
            return self._turn(values, stamp_ns)
        return self._quantise(values + self._error(values.size, stamp_ns))

    def _turn(self, q: NDArray[np.float64], stamp_ns: int) -> NDArray[np.float64]:
        """Turn an orientation by an error, and give it the norm 1 that devices give."""
        turned = self._quantise(multiply(q, from_rotation(self._error(3, stamp_ns))))
        return turned / np.linalg.norm(turned)

    def _error(self, size: int, stamp_ns: int) -> NDArray[np.float64]:
        sample = self._generator(stamp_ns).standard_normal(size)
        return self._bias[:size] + self._distortion.noise * sample

    def _quantise(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        if not self._distortion.step:
            return values
        with np.errstate(over='ignore'):
            steps = values / self._distortion.step
        # Beyond that many steps, neighbouring doubles are further apart than the steps.
        fine = np.abs(steps) >= _MOST_STEPS
        return np.where(fine, values, self._distortion.step * np.round(steps))

    def _generator(self, stamp_ns: int, constant: bool = False) -> np.random.Generator:
        """Return the generator of a sample; the low words of the counter are its own draws."""
        counter = np.array([0, 0, stamp_ns, int(constant)], dtype=np.uint64)
        return np.random.Generator(np.random.Philox(key=self._key, counter=counter))


def from_rotation(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the quaternion x y z w of a rotation vector (3,) [rad]."""
    half = 0.5 * float(np.linalg.norm(rotation))
    # sin(half) / (2 half) times the vector, without dividing by zero: numpy's sinc has pi in it.
    return np.append(0.5 * np.sinc(half / np.pi) * rotation, np.cos(half))


def multiply(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return Hamilton's product of quaternions x y z w: first b, then a."""
    vector = a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])
    return np.append(vector, a[3] * b[3] - a[:3] @ b[:3])
