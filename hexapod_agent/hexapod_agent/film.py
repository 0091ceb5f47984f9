# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `film`: an episode of a checkpoint, or of a straight walk, as a film or a strip."""

import argparse
import math
from collections.abc import Collection, Iterator, Sequence

import numpy as np
from hexapod_cpg.mapping import ACTION_SIZE
from hexapod_sim.command_line import MOST_SEED, CommandLine, file, number, output_file, whole
from hexapod_sim.film import (
    FILMS,
    MOST_HEIGHT,
    MOST_WIDTH,
    PICTURES,
    Camera,
    FilmError,
    Frame,
    strip,
    write_film,
    write_picture,
)
from hexapod_sim.robot import CONTROL_PERIOD_NS

from hexapod_agent.algorithms.policies import Policy, constant_policy
from hexapod_agent.deployment import agent_file
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.specification.run_spec import ConfigError, RunSpec
from hexapod_agent.specification.spec_text import add_spec_options

_PERIODS_PER_FRAME = 2
FRAMES_PER_SECOND = 1_000_000_000 // (CONTROL_PERIOD_NS * _PERIODS_PER_FRAME)


def main(args: Sequence[str] | None = None) -> None:
    """Film what the command line names."""
    parser = _parser()
    options = parser.parse_args(args)
    if not (options.out or options.strip):
        parser.error('nothing to write, expected --out or --strip')
    try:
        env, policy = _subject(options)
        count = math.ceil(_steps(options) / _PERIODS_PER_FRAME)
        chosen = np.linspace(0, count - 1, options.frames).round().astype(int).tolist()
        frames = list(film(env, policy, options, None if options.out else chosen))
        if options.out:
            write_film(frames, options.out, FRAMES_PER_SECOND)
            chosen = np.linspace(0, len(frames) - 1, options.frames).round().astype(int).tolist()
            frames = [frames[index] for index in chosen] if options.strip else []
        if options.strip:
            write_picture(strip(frames), options.strip)
    except (ConfigError, agent_file.CheckpointError, FilmError, OSError) as error:
        parser.error(str(error))


def _steps(options: argparse.Namespace) -> int:
    """Return the control periods of the longest film."""
    return round(options.seconds * 1e9 / CONTROL_PERIOD_NS)


def film(
    env: HexapodLine,
    policy: Policy,
    options: argparse.Namespace,
    chosen: Collection[int] | None = None,
) -> Iterator[Frame]:
    """Yield the pictures of an episode, `FRAMES_PER_SECOND` of them per simulated second.

    Args:
        env: Where it is played.
        policy: Who plays it.
        options: Of the command line.
        chosen: Numbers of the pictures that are wanted; by default all.
    """
    observation, _ = env.reset(seed=options.seed)
    size = (options.width, options.height)
    camera = Camera(env.task.simulation, options.camera, *size, options.zoom)
    steps = _steps(options)
    try:
        while env.outcome.step < steps and not (env.outcome.terminated or env.outcome.truncated):
            number, rest = divmod(env.outcome.step, _PERIODS_PER_FRAME)
            if not rest and (chosen is None or number in chosen):
                yield camera.shoot()
            observation, *_ = env.step(policy(observation))
    finally:
        camera.close()


def _parser() -> CommandLine:
    parser = CommandLine(prog='film', description=__doc__)
    add = parser.add_argument
    add('checkpoint', nargs='?', type=file, help='file of train; default: action zero')
    add_spec_options(parser)
    add('--seed', type=whole(0, MOST_SEED), default=1, help='seed of the start (default 1)')
    add('--seconds', type=number(0.05, 600.0), default=6.0, help='longest film (default 6)')
    add('--camera', choices=('track', 'top'), default='track')
    add('--zoom', type=number(0.1, 20.0), default=1.6, help='of the lens (default 1.6)')
    add('--width', type=whole(16, MOST_WIDTH), default=480, help='pixels (default 480)')
    add('--height', type=whole(16, MOST_HEIGHT), default=320, help='pixels (default 320)')
    add('--out', type=output_file(*FILMS), help='film to write, .gif or .mp4')
    add('--strip', type=output_file(*PICTURES), help='picture of frames side by side to write')
    add('--frames', type=whole(1, 50), default=5, help='frames of the strip (default 5)')
    return parser


def _subject(options: argparse.Namespace) -> tuple[HexapodLine, Policy]:
    """Environment and policy that the options ask for."""
    if not options.checkpoint:
        config = RunSpec.load(options.config, options.set)
        return HexapodLine('', config), constant_policy(np.zeros(ACTION_SIZE, np.float32))
    agent = agent_file.load(options.checkpoint)
    config = agent.config.changed_by(options.config) if options.config else agent.config
    return HexapodLine(config=config.with_settings(options.set)), agent.policy


if __name__ == '__main__':
    main()
