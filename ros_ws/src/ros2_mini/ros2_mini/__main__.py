# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Run the command line: `python -m ros2_mini`."""

import sys

from ros2_mini.cli import main

sys.exit(main())
