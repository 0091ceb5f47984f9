# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The commands, a module each, imported when the command line names it."""
