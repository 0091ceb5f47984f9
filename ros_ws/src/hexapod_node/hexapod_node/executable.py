# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What an executable of a node begins with: a signal ends it well even while libraries load."""

from collections.abc import Callable
from importlib import import_module

from hexapod_node import signals


def executable(module: str) -> Callable[[], None]:
    """Return the entry point of a module with a `main`, which is loaded when it is called.

    Loading takes seconds where PyTorch is among it; until `hexapod_node.spin` takes the signals
    over, one of them ends the process at once, with status 0.
    """

    def main() -> None:
        signals.end_at_once()
        import_module(module).main()

    return main
