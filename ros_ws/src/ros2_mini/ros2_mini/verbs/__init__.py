# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""One module per verb, with `add_arguments(parser)` and `main(args) -> int`."""
