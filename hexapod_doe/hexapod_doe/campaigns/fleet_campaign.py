# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The rows of a campaign that are due, as the runs of a fleet, with what is shown of them."""

from collections.abc import Collection
from contextlib import ExitStack
from datetime import datetime
from types import TracebackType
from typing import Self

from hexapod_agent.learning.summary import EpisodeSummary
from hexapod_agent.specification.run_spec import ConfigError

from hexapod_doe.campaigns.campaign import Campaign
from hexapod_doe.campaigns.campaign_lock import row_lock
from hexapod_doe.campaigns.dashboard import Dashboard
from hexapod_doe.campaigns.failures import FailureLog, read_failures
from hexapod_doe.campaigns.fleet_row import FleetRow
from hexapod_doe.campaigns.page import PageWriter
from hexapod_doe.campaigns.row import Row
from hexapod_doe.campaigns.stop_rule import StopRule, stopped_text
from hexapod_doe.errors import CampaignError

_NAME = 'fleet'


class FleetCampaign:
    """Gives a fleet one row after another, and counts what comes back."""

    def __init__(
        self,
        campaign: Campaign,
        device: str,
        began: datetime,
        rule: StopRule,
    ) -> None:
        """Begin with the rows that are due.

        Args:
            campaign: whose rows.
            device: where the networks are.
            began: when the command was given; what failed since, in whatever process, is not
                tried again.
            rule: that may end the campaign before its plan is done.
        """
        self._campaign, self._device, self._rule = campaign, device, rule
        self._dashboard = Dashboard(campaign)
        self._page = PageWriter(campaign.directory, self._dashboard.log)
        self._locks: dict[str, ExitStack] = {}
        self._elsewhere: set[str] = set()
        self._failures = FailureLog(campaign.directory)
        self._began = began

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._page.close()
        self._dashboard.close()

    def take(self, among: Collection[str]) -> FleetRow | None:
        """Begin the next row that is due and that no other process is at.

        Args:
            among: run ids of those that may be begun.

        Raises:
            BagError: its bag cannot be written.
        """
        while (row := self._next(among)) is not None:
            self._dashboard.begin(_place(row), row.run_id)
            self._page.refresh()
            try:
                return FleetRow(row, self._device, self)
            except ConfigError as error:  # of this row alone
                self.end(row, error)
        return None

    def _next(self, among: Collection[str]) -> Row | None:
        elsewhere = []
        self._ask_the_rule()
        while (row := self._campaign.take(_NAME, among=among)) is not None:
            if not self._lock(row):
                elsewhere.append(row)
            elif self._campaign.has_bag(row) or self._in_vain(row):  # another process was at it
                self._locks.pop(row.run_id).close()
                self._campaign.complete(row, self._in_vain(row))
            else:
                break
        for each in elsewhere:  # due again, should that process leave it
            self._campaign.release(each)
        return row

    def _ask_the_rule(self) -> None:
        """Look whether the campaign is to end, by what this process or another one finds."""
        campaign = self._campaign
        if campaign.stopped:
            return
        text = self._rule.look() if self._rule.due() else ''
        campaign.stopped = text or stopped_text(campaign.directory)
        if campaign.stopped:
            self.log(campaign.stopped)

    def _in_vain(self, row: Row) -> str:
        """Return why the row failed since the command was given, '' if it did not."""
        reasons = read_failures(self._campaign.directory, self._began)
        return reasons.get(row.run_id, [''])[-1]

    def _lock(self, row: Row) -> bool:
        """Return whether the row is ours until it ends."""
        lock = ExitStack()
        try:
            lock.enter_context(row_lock(row.bag))
        except CampaignError:  # of the folder nothing is wrong: the fleet has begun in it
            if row.run_id not in self._elsewhere:
                self._elsewhere.add(row.run_id)
                self.log(f'{row.run_id} is left to the process that is at it')
            return False
        self._locks[row.run_id] = lock
        return True

    def log(self, text: str) -> None:
        """Show a line."""
        self._dashboard.log(text)

    def episode(self, row: Row, summary: EpisodeSummary) -> None:
        """Show an episode."""
        number, value = summary.episode, summary.episode_return
        self._dashboard.episode(_place(row), row.run_id, number, value)

    def end(self, row: Row, error: Exception | None) -> None:
        """Judge a row as the manager does: it is done if its bag is whole."""
        campaign = self._campaign
        text = f'{row.run_id}  {row.text}'
        done = campaign.complete(row, str(error or ''))
        if not done:
            reason = campaign.reasons[row.run_id][-1]
            text = f'{row.run_id} failed: {reason}'
            self._failures.add(row.run_id, _NAME, reason)
        self._locks.pop(row.run_id).close()  # who has the row next knows how it ended
        self._dashboard.end(_place(row), text, done=done)
        self._page.refresh()


def _place(row: Row) -> str:
    """Return the name under which a row is shown while it is trained."""
    return f'/{_NAME}/{row.run_id}'
