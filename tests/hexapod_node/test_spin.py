# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The end of a node's process: bounded even where the middleware does not come back."""

import subprocess
import sys

# PyDLL keeps Python's lock during the call, as rclpy does while it destroys a participant.
STUCK = """
import ctypes
import hexapod_node.spin as spin
from rclpy.node import Node

class Stuck(Node):
    exit_status = 0
    def destroy_node(self):
        ctypes.PyDLL(None).sleep(60)

spin._TEARDOWN_S = 1.0
spin.run(lambda: Stuck('stuck'))
"""


def test_middleware_that_hangs_at_the_end_does_not_hang_the_process():
    done = subprocess.run(
        [sys.executable, '-c', STUCK], capture_output=True, text=True, timeout=30, check=False
    )
    assert done.returncode == 1
    assert 'in destroy_node' in done.stderr


# A signal ends the context whatever callback is at work.
BUSY = """
import hexapod_node.spin as spin
import rclpy
from rclpy.node import Node
from rosgraph_msgs.msg import Clock

class Busy(Node):
    def __init__(self):
        super().__init__('busy')
        self.publisher = self.create_publisher(Clock, 'clock', 1)
        self.create_timer(0.01, self.work)

    def work(self):
        rclpy.shutdown()
        self.publisher.publish(Clock())

spin.run(Busy)
"""


def test_a_signal_amid_a_callback_ends_the_process_as_any_other():
    done = subprocess.run(
        [sys.executable, '-c', BUSY], capture_output=True, text=True, timeout=30, check=False
    )
    assert done.returncode == 0, done.stderr
    assert 'Traceback' not in done.stderr
