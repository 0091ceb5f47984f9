# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The errors that users of campaigns, bags and analyses meet."""


class BagError(ValueError):
    """A bag cannot be read or written; the text names the path and what was expected of it."""


class LockingError(ValueError):
    """A folder lies where files cannot be locked; the text names it and says what to choose."""


class UnfinishedError(BagError):
    """A bag is closed, and does not hold all that its run was to have."""


class AnalysisError(ValueError):
    """A table or an option does not allow the analysis; the text names it and the expectation."""


class CampaignError(ValueError):
    """A campaign cannot go on; the text names its folder and what was expected of it."""


class TableError(AnalysisError):
    """A table cannot be read or analysed; the text names the file, row or column, and the cure."""
