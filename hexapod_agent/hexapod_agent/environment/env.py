# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The Gymnasium environment HexapodLine-v0, on the code that the ROS nodes run."""

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from hexapod_cpg.cpg import Cpg
from hexapod_cpg.mapping import ACTION_SIZE, command_from_action
from hexapod_sim.film import Frame
from hexapod_sim.picture import Picture
from hexapod_sim.robot import CONTROL_PERIOD_NS, NEUTRAL_POSE, SUBSTEPS
from hexapod_sim.task import LineTask, Outcome, episode_seed
from hexapod_sim.viewer import has_display
from numpy.typing import NDArray

from hexapod_agent.specification.observation import ObservationError, ObservationSpec
from hexapod_agent.specification.run_spec import RunSpec

Observation = NDArray[np.float32]

_STANDING = np.tile(NEUTRAL_POSE, (SUBSTEPS, 1))


def read_observation(
    task: LineTask,
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    spec: ObservationSpec,
    previous_action: NDArray[np.float32],
) -> Observation:
    """Observe a robot at the end of a control period, reading what the set needs and no more.

    Args:
        task: The robot and its line.
        x: First state of its oscillators (6,).
        y: Second state (6,).
        spec: What is observed.
        previous_action: Action (30,) of the period that just ended.

    Raises:
        ObservationError: A reading is not finite.
    """
    readings = task.sensors.observe(spec.channels)
    readings['oscillator'] = np.concatenate((x, y))
    return spec.assemble(readings, previous_action)


class LineEnv(gymnasium.Env[Observation, NDArray[np.float32]]):
    """What the environments of a walk along a line have in common: spaces, runs and episodes.

    Attributes:
        config: What decides a run.
        observation_spec: What is observed.
    """

    def __init__(self, observations: str | None, config: RunSpec | str | Path | None) -> None:
        spec = config if isinstance(config, RunSpec) else RunSpec.load(config)
        self.config = spec if observations is None else spec.observing(observations)
        self.observation_spec = self.config.observed
        self.observation_space = gymnasium.spaces.Box(
            -1.0, 1.0, (self.observation_spec.size,), np.float32
        )
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (ACTION_SIZE,), np.float32)
        self._run_seed = 0
        self._episode = -1

    def _begin(self, seed: int | None, options: dict[str, Any] | None) -> int:
        """Return the seed of the episode that a reset begins."""
        super().reset(seed=seed)
        if seed is not None:
            self._run_seed, self._episode = seed, -1
        elif self._episode < 0:
            self._run_seed = int(self.np_random.integers(2**63))
        self._episode = (options or {}).get('episode', self._episode + 1)
        return episode_seed(self._run_seed, self._episode)


class HexapodLine(LineEnv):
    """A hexapod that walks to a line on the floor and along it.

    ## Action space
    `Box(-1, 1, (30,), float32)`: five numbers per leg, in the leg order lf lm lr rf rm rr. Each
    one is scaled by the ranges of the configuration (here: value at 0, half width).

    | Num | Action | At 0 | Half width | Unit |
    |-----|--------|------|------------|------|
    | 5 i | hip gain: hip angle per unit of x of oscillator i | 0.25 | 0.15 | rad |
    | 5 i + 1 | knee gain: knee angle per unit of -y | 0.25 | 0.10 | rad |
    | 5 i + 2 | knee bias | 0 | 0.10 | rad |
    | 5 i + 3 | ankle gain: ankle angle per unit of -y | 0 | 0.15 | rad |
    | 5 i + 4 | ankle bias | 0 | 0.10 | rad |

    ## Observation space
    `Box(-1, 1, (n,), float32)`, n = 79 plus the chosen channels. A number is its reading over
    its scale, clipped; the height is taken from 0.13 m.

    | Letter | Observation | Count | Scale | Unit |
    |--------|-------------|-------|-------|------|
    | always | joint angles, lf_hip lf_knee lf_ankle lm_hip ... | 18 | 1 | rad |
    | always | joint velocities | 18 | 6.2 | rad/s |
    | always | oscillators: x of six legs, y of six legs | 12 | 1.2 | 1 |
    | always | previous action | 30 | 1 | 1 |
    | always | offset from the line, positive to its left | 1 | 1 | m |
    | A | joint torques | 18 | 1.5 | N·m |
    | B | linear velocity of the body, body frame | 3 | 0.5 | m/s |
    | C | orientation quaternion x y z w | 4 | 1 | 1 |
    | D | angular velocity of the body, body frame | 3 | 2 | rad/s |
    | E | height of the body above ground | 1 | 0.05 | m |
    | F | foot forces: six normal, six friction | 12 | 20 | N |
    | G | foot contacts, 0 or 1 | 6 | 1 | 1 |

    ## Rewards
    The sum of the terms in `info['terms']`: velocity along the line, closeness to the line,
    orientation penalty, height penalty, and a constant. `hexapod_sim.task` defines them, the
    configuration weighs them.

    ## Starting state
    The robot stands at a random distance of up to 0.5 m to either side of the line, heading
    along it. `reset(seed=s)` begins run s at episode 0, each further `reset()` its next episode;
    `options={'episode': e}` goes to episode e. The same run and episode start alike.

    ## Episode end
    Terminated when the robot flips, collapses or strays from the line; truncated after 600
    steps of 25 ms. `info['cause']` names which.

    ## Information
    `terms` (each reward term), `line_offset` (m), `joint_targets` (5, 18) in rad sent during the
    step, at the start the standing pose, `cause`.

    ## Arguments
    `observations`: letters of the optional channels, None for those of `config`. `config`: a
    `RunSpec`, the path of a YAML file, or None for article.yaml. `render_mode`: None,
    `rgb_array` (`render()` draws off-screen, which needs EGL), or `human` (a window in real
    time, where there is a display). `width`, `height`: pixels of a picture. `camera`: `track` or
    `top`.

    ## Copies
    `copy.deepcopy` and `pickle` give an environment that goes on as this one, to the last bit.
    A copy draws anew: pictures and windows stay with the original.

    ## Version history
    * v0: first version.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 (gymnasium's type)
        'render_modes': ['rgb_array', 'human'] if has_display() else ['rgb_array'],
        'render_fps': 1_000_000_000 // CONTROL_PERIOD_NS,
    }

    def __init__(
        self,
        observations: str | None = None,
        config: RunSpec | str | Path | None = None,
        render_mode: str | None = None,
        width: int = 480,
        height: int = 320,
        camera: str = 'track',
    ) -> None:
        super().__init__(observations, config)
        self.task = LineTask(self.config.task, self.config.sensors, self.config.world)
        self.cpg = Cpg(self.config.cpg.hopf)
        self._previous_action = np.zeros(ACTION_SIZE, np.float32)
        self._joint_targets = _STANDING.copy()
        self._picture = Picture(self.task.simulation, render_mode, width, height, camera)
        self.render_mode = render_mode
        self.outcome = Outcome(0, 0.0, {}, False, False, '')

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode; see the class for seed and options."""
        chosen = self._begin(seed, options)
        self.outcome = self.task.reset(chosen)
        self.cpg.reset()
        self._previous_action = np.zeros(ACTION_SIZE, np.float32)
        self._joint_targets = _STANDING.copy()
        self._picture.advance()
        return self._observe(), self._info()

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Advance one control period of 25 ms."""
        cpg = self.config.cpg
        command = command_from_action(action, cpg.reading, cpg.ranges)
        self._joint_targets = self.cpg.advance(command)
        self.outcome = self.task.advance(self._joint_targets)
        self._previous_action = action
        outcome = self.outcome
        observation = self._observe()
        self._picture.advance()
        return observation, outcome.reward, outcome.terminated, outcome.truncated, self._info()

    def render(self) -> Frame | None:
        """Return the picture of now (height, width, 3), RGB; in a window there is none.

        Raises:
            hexapod_sim.film.FilmError: There is nothing to draw with.
            hexapod_sim.viewer.ViewerError: There is no display.
        """
        if self.render_mode is None:
            gymnasium.logger.warn(
                "render: the environment was made without render_mode, expected 'rgb_array' or "
                "'human'"
            )
        return self._picture.draw()

    def close(self) -> None:
        """Close what `render` has opened."""
        self._picture.close()

    def _observe(self) -> Observation:
        """Read what the set of channels needs, and nothing else."""
        cpg, spec = self.cpg, self.observation_spec
        try:
            return read_observation(self.task, cpg.x, cpg.y, spec, self._previous_action)
        except ObservationError as error:
            raise ObservationError(
                f'{error} (step {self.outcome.step} of episode {self._episode}, '
                f'seed {self._run_seed})'
            ) from error

    def _info(self) -> dict[str, Any]:
        return {
            'terms': self.outcome.terms,
            'line_offset': self.task.line_offset,
            'joint_targets': self._joint_targets,
            'cause': self.outcome.cause,
        }
