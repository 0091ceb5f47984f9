# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Tables as files, as spreadsheets and other programs write them, read into cells and numbers."""
