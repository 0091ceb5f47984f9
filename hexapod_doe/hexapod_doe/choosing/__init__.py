# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Choices: predictions of every set, their uncertainty, failures, devices and confirmation."""
