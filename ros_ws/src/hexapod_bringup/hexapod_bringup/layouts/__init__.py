# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Layouts that show a run in Foxglove and in PlotJuggler, made of one table of plots."""
