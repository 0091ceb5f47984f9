# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What the report says of the lines to type next."""

from hexapod_doe.records.results import Analysis
from hexapod_doe.reporting.text import is_tour


def lead(analysis: Analysis) -> str:
    """Return what the lines to type next are for."""
    if is_tour(analysis):
        return 'A campaign that is long enough to decide by: what a night here pays for.'
    if analysis.confirmation is None:
        return 'More runs of each case tell how much runs differ by chance.'
    if any(check.observed for check in analysis.confirmation.checks):
        return 'An agent with the set that was chosen, and what it does from other starts.'
    return (
        'New runs with seeds of their own confirm the choice, by the rule that the plan fixed '
        'before the first run.'
    )
