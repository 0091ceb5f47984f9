# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A trained agent in the Gymnasium environment, beside the gait that it began with.

python examples/walk.py --starts 5
"""

import argparse
from pathlib import Path

import gymnasium
import numpy as np
from hexapod_agent.deployment import agent_file

AGENT = Path('ros_ws/src/hexapod_bringup/agents/ABCDE.pt')


def main() -> None:
    """Print what both earn from the same starts, and where they end."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('agent', type=Path, nargs='?', default=AGENT)
    parser.add_argument('--starts', type=int, default=5)
    args = parser.parse_args()

    agent = agent_file.load(args.agent)
    env = gymnasium.make('hexapod_agent:HexapodLine-v0', config=agent.config)
    still = np.zeros(env.action_space.shape, np.float32)
    for name, act in {'agent': agent.policy, 'zero action': lambda _: still}.items():
        returns, offsets = [], []
        for start in range(args.starts):
            observation, info = env.reset(seed=1, options={'episode': start})
            earned, over = 0.0, False
            while not over:
                observation, reward, terminated, truncated, info = env.step(act(observation))
                earned += float(reward)
                over = terminated or truncated
            returns.append(earned)
            offsets.append(abs(info['line_offset']))
        print(f'{name}: return {np.mean(returns):.0f}, {np.mean(offsets):.3f} m from the line')
    env.close()


if __name__ == '__main__':
    main()
