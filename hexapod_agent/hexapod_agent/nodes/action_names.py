# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Names under which an agent offers the action TrainRun, relative to its worker's namespace."""

TRAIN_RUN = 'train_run'
"""Of a worker that campaigns find, and give the rows of their plan."""
PLAY_RUN = 'play_run'
"""Of a worker that is there for somebody in particular: no campaign looks for it."""
