# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Tells what a command is at, where that takes long enough to wonder."""

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

_PATIENCE_S = 2.0


@contextmanager
def stage(text: str, patience_s: float = _PATIENCE_S) -> Iterator[None]:
    """Print one line on standard error if what follows takes longer than a user's patience."""
    timer = threading.Timer(patience_s, _tell, [text])
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _tell(text: str) -> None:
    print(f'{text} ...', file=sys.stderr, flush=True)
