# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The one exception that a verb raises for a request it cannot meet."""


class CommandError(RuntimeError):
    """A request that cannot be met; the message is one line and names the thing.

    The command line prints it on standard error and exits with 1, as the original does.
    """
