# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""How far the robot tilted, by its own IMU: a bag without ROS.

python examples/read_bag.py bags/sample
"""

import argparse
from pathlib import Path

import numpy as np
from hexapod_doe.bags.run_record import read_run, read_topic


def main() -> None:
    """Print a run's episodes, and the tilt and speed of what was recorded of them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('bag', type=Path, nargs='?', default=Path('bags/sample'))
    bag = parser.parse_args().bag

    run = read_run(bag)
    print(f'run {run.run_id}, sensors {run.metadata["observations"] or "always-on alone"}')
    print(run.episodes[['steps', 'episode_return', 'cause']].to_string())

    imu = [message.orientation for _, message in read_topic(bag, 'imu/data')]
    x, y = (np.array([getattr(q, axis) for q in imu]) for axis in 'xy')
    up = 1.0 - 2.0 * (x * x + y * y)  # z of the body's z axis, of a unit quaternion
    tilt = np.degrees(np.arccos(np.clip(up, -1.0, 1.0)))
    speed = [message.twist.linear.x for _, message in read_topic(bag, 'body/twist')]
    print(f'{len(imu)} samples: tilt {tilt.mean():.1f} degrees, at most {tilt.max():.1f}')
    print(f'speed ahead {np.mean(speed):.2f} m/s, at most {np.max(speed):.2f}')


if __name__ == '__main__':
    main()
