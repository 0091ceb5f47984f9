# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the stop rule asks of an analysis: the choice, and what it is expected to lose."""

from pathlib import Path

from hexapod_doe.campaigns.row import RUNS_FOLDER
from hexapod_doe.campaigns.stop_rule import Look
from hexapod_doe.errors import AnalysisError, BagError


def look_at(directory: Path) -> Look:
    """Return what `analyze` would choose from the finished runs of a campaign.

    Runs that cannot be analysed yet are no error: the reason is part of the answer.
    """
    # A campaign without a rule imports none of this.
    from hexapod_doe.choosing.choice import decide, expected_loss
    from hexapod_doe.records.options import Options
    from hexapod_doe.tables.bag_table import read_bags

    options = Options()
    try:
        table = read_bags([directory / RUNS_FOLDER])[0]
        outlook = decide(table, options)
    except (AnalysisError, BagError) as error:
        return Look(0, '', None, str(error))
    return Look(len(table.rows), outlook.ranking[0], expected_loss(outlook, options.seed))
