# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Launch files in XML: `document` reads one, `expand` makes a plan of it, `supervisor` runs that.

The subset is the one that `document.RULES` lists; every file in it means the same to the launch
library of a full ROS 2 install.
"""
