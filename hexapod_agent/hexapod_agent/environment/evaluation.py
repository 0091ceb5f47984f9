# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How well a policy does the task: noise-free episodes from seeded starts, in numbers."""

from dataclasses import dataclass

import numpy as np
from hexapod_sim.recovery import LATE_STEPS, has_recovered
from hexapod_sim.robot import CONTROL_PERIOD_NS
from hexapod_sim.sensors import read
from hexapod_sim.sums import ordered_sum
from numpy.typing import NDArray

from hexapod_agent.algorithms.policies import Policy
from hexapod_agent.environment.env import HexapodLine

_PERIOD_S = CONTROL_PERIOD_NS * 1e-9
_LAST_STEPS = 200  # 5 s, in which the offset is judged


class GraphError(RuntimeError):
    """The graph did not play what it was asked to; the text gives the agent's reason."""


@dataclass(frozen=True)
class Episode:
    """One evaluated episode.

    Attributes:
        episode_return: Sum of the rewards.
        offsets: Offset from the line after each step (steps,), m.
        distance: Way made good along the line, m.
        energy: Integral of |torque x velocity| over all joints, J.
        fell: Whether it ended by a failure.
        late_speed: Way along the line over time, of the last 8 s or all of a shorter one, m/s.
    """

    episode_return: float
    offsets: NDArray[np.float64]
    distance: float
    energy: float
    fell: bool
    late_speed: float


@dataclass(frozen=True)
class Evaluation:
    """Figures over all starts.

    Attributes:
        starts: Episodes.
        final_average_reward: Mean return.
        return_deviation: Standard deviation of the returns between starts.
        mean_offset: Mean |offset| over the last 5 s of the episodes, m.
        offset_95: 95th percentile of the same, m.
        speed: Way along the line over time, m/s.
        falls: Episodes that ended by a failure.
        energy_per_metre: Mechanical energy over way along the line, J/m; NaN without way.
        late_speed: Mean of the episodes' late speeds, m/s.
        recovered: Episodes of a varied robot that did not fail and had half the late speed that
            the same agent has with the robot as it was built; None of a robot that is.
    """

    starts: int
    final_average_reward: float
    return_deviation: float
    mean_offset: float
    offset_95: float
    speed: float
    falls: int
    energy_per_metre: float
    late_speed: float
    recovered: int | None = None


class EpisodeMeter:
    """Adds up one episode as it happens, in the environment or on the graph."""

    def __init__(self, x: float) -> None:
        """Begin at the start of an episode, where the robot stands at x [m] of odom."""
        self._xs = [x]
        self._return = 0.0
        self._power = 0.0
        self._offsets: list[float] = []

    def add(
        self,
        reward: float,
        offset: float,
        x: float,
        torques: NDArray[np.float64],
        velocities: NDArray[np.float64],
    ) -> None:
        """Count one control period by what it earned and by the readings at its end.

        Args:
            reward: What it earned.
            offset: Offset from the line, m.
            x: Position along the line, m.
            torques: Joint torques (18,), N m.
            velocities: Joint velocities (18,), rad/s.
        """
        self._xs.append(x)
        self._return += reward
        self._offsets.append(offset)
        self._power += float(np.abs(torques * velocities).sum())

    def episode(self, fell: bool) -> Episode:
        """Close the episode."""
        way, energy = self._xs[-1] - self._xs[0], self._power * _PERIOD_S
        late = self._xs[-1 - LATE_STEPS :]
        late_speed = (late[-1] - late[0]) / (max(len(late) - 1, 1) * _PERIOD_S)
        return Episode(self._return, np.array(self._offsets), way, energy, fell, late_speed)


def run_episode(env: HexapodLine, policy: Policy, seed: int, episode: int) -> Episode:
    """Let a policy run one episode of an environment."""
    observation, _ = env.reset(seed=seed, options={'episode': episode})
    simulation = env.task.simulation
    meter = EpisodeMeter(float(simulation.position[0]))
    while not (env.outcome.terminated or env.outcome.truncated):
        observation, reward, *_ = env.step(policy(observation))
        joints = read(simulation, ('joint_torques', 'joint_velocities'))
        x = float(simulation.position[0])
        meter.add(reward, env.task.line_offset, x, *joints.values())
    return meter.episode(env.outcome.terminated)


def summarize(episodes: list[Episode], undamaged_speed: float | None = None) -> Evaluation:
    """Reduce episodes to figures.

    Args:
        episodes: From all starts.
        undamaged_speed: Mean late speed of the robot as it was built, m/s, if they are of a
            varied one.
    """
    returns = [episode.episode_return for episode in episodes]
    offsets = np.abs(np.concatenate([episode.offsets[-_LAST_STEPS:] for episode in episodes]))
    distance = ordered_sum(episode.distance for episode in episodes)
    time = sum(episode.offsets.size for episode in episodes) * _PERIOD_S
    energy = ordered_sum(episode.energy for episode in episodes)
    return Evaluation(
        starts=len(episodes),
        final_average_reward=float(np.mean(returns)),
        return_deviation=float(np.std(returns)),
        mean_offset=float(offsets.mean()),
        offset_95=float(np.percentile(offsets, 95)),
        speed=distance / time,
        falls=sum(episode.fell for episode in episodes),
        energy_per_metre=energy / distance if distance > 0.0 else float('nan'),
        late_speed=ordered_sum(episode.late_speed for episode in episodes) / len(episodes),
        recovered=None
        if undamaged_speed is None
        else sum(has_recovered(e.fell, e.late_speed, undamaged_speed) for e in episodes),
    )
