# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The rows of a campaign that are due, as the runs of a fleet, with what is shown of them."""

from __future__ import annotations

from collections.abc import Iterator
from types import TracebackType
from typing import Self

from hexapod_agent.config import AgentConfig
from hexapod_agent.summary import EpisodeSummary

from hexapod_doe.campaigns.campaign import Campaign, Row
from hexapod_doe.campaigns.dashboard import Dashboard
from hexapod_doe.campaigns.fleet_row import FleetRow
from hexapod_doe.campaigns.page_writer import PageWriter

_NAME = 'fleet'


class FleetCampaign:
    """Gives a fleet one row after another, and counts what comes back."""

    def __init__(
        self, campaign: Campaign, config: AgentConfig, episodes: int, device: str
    ) -> None:
        self._campaign, self._config = campaign, config
        self._episodes, self._device = episodes, device
        self._dashboard = Dashboard(campaign, episodes)
        self._page = PageWriter(campaign.directory, self._dashboard.log)

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

    def runs(self) -> Iterator[FleetRow]:
        """Yield the rows that are due, each begun when it is asked for.

        Raises:
            BagError: a row cannot be begun.
        """
        while (row := self._campaign.take(_NAME)) is not None:
            self._dashboard.begin(self._place(row), row.run_id, row.observations)
            yield FleetRow(
                row, self._config, self._episodes, self._device, self._on_episode, self._on_end
            )
            self._page.refresh()

    def _place(self, row: Row) -> str:
        """Return the name under which a row is shown while it is trained."""
        return f'/{_NAME}/{row.run_id}'

    def _on_episode(self, row: Row, summary: EpisodeSummary) -> None:
        self._dashboard.episode(
            self._place(row), row.run_id, summary.episode, summary.episode_return
        )

    def _on_end(self, row: Row, error: Exception | None) -> None:
        """Judge a row as the manager does: it is done if its bag is whole."""
        campaign = self._campaign
        if error is not None:
            campaign.fail(row, str(error))
        done = error is None and campaign.complete(row)
        sensors = f'{row.run_id}  sensors {row.observations or "none"}'
        text = sensors if done else f'{row.run_id} failed: {campaign.reasons[row.run_id][-1]}'
        self._dashboard.end(self._place(row), text, done=done)
        self._page.refresh()
