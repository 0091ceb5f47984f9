# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import io

import pytest
from hexapod_doe.campaigns.campaign import PLAN_FILE, Campaign
from hexapod_doe.campaigns.changes import Changes
from hexapod_doe.campaigns.dashboard import Dashboard
from hexapod_doe.campaigns.progress import State
from rich.console import Console


class Shown:
    """A dashboard on a terminal of its own."""

    def __init__(self, folder, terminal: bool) -> None:
        self.text = io.StringIO()
        self.campaign = Campaign.open(
            folder.directory / PLAN_FILE, attempts=1, changes=Changes.of(None, (), 5)
        )
        console = Console(file=self.text, force_terminal=terminal, width=120, highlight=False)
        self.dashboard = Dashboard(self.campaign, console)

    def run(self, run_id: str) -> None:
        """Play a whole run on the worker w1."""
        self.dashboard.begin('/w1', run_id)
        for episode in range(5):
            self.dashboard.episode('/w1', run_id, episode, 10.0 * episode)


@pytest.fixture(params=[True, False], ids=['terminal', 'log'])
def shown(folder, request):
    """Yield a dashboard of a campaign of which one row is done."""
    folder.finish('r4')
    made = Shown(folder, request.param)
    yield made
    made.dashboard.close()


def test_what_was_done_before_counts(shown):
    assert shown.dashboard.progress.episodes == 5
    assert shown.dashboard.progress.planned == 20


def test_a_run_is_followed_to_its_end(shown, folder):
    shown.run('r3')
    assert shown.dashboard.progress.runs['r3'].state is State.RUNNING
    assert shown.dashboard.progress.runs['r3'].phase == 'evaluating'
    assert shown.dashboard.progress.episodes == 10
    assert shown.dashboard.episodes_per_second > 0.0
    folder.finish('r3')
    shown.dashboard.end('/w1', 'r3  reward 20.0', done=True)
    assert shown.dashboard.progress.runs['r3'].reward == 20.0
    assert '2/4 r3  reward 20.0' in shown.text.getvalue()


def test_a_failed_row_says_why(shown):
    shown.run('r3')
    row = next(row for row in shown.campaign.rows if row.run_id == 'r3')
    shown.campaign.fail(row, 'the disk is full')
    shown.dashboard.end('/w1', 'r3 failed', done=False)
    assert shown.dashboard.progress.runs['r3'].reason == 'the disk is full'
    assert shown.dashboard.progress.runs['r3'].state is State.FAILED


def test_a_row_that_is_given_up_is_due_again(shown):
    shown.run('r3')
    shown.dashboard.end('/w1', '/w1 is gone', done=False)
    assert shown.dashboard.progress.runs['r3'].state is State.DUE
    assert shown.dashboard.progress.episodes == 5
    shown.dashboard.episode('/w1', 'r3', 5, 0.0)  # its last words
    assert shown.dashboard.progress.episodes == 5


def test_a_worker_that_is_lost_before_its_run_begins_is_one_line(shown):
    shown.dashboard.end('/w9', '/w9 is gone', done=False)
    assert '/w9 is gone' in shown.text.getvalue()
    assert shown.dashboard.progress.episodes == 5


def test_a_resumed_run_begins_where_it_was(shown):
    shown.dashboard.begin('/w1', 'r3')
    shown.dashboard.episode('/w1', 'r3', 3, 1.0)
    run = shown.dashboard.progress.runs['r3']
    assert (len(run.returns), run.earlier) == (4, 3)


def test_the_screen_shows_workers_curves_and_failures(folder):
    shown = Shown(folder, terminal=True)
    shown.run('r3')
    row = shown.campaign.rows[0]
    shown.dashboard.begin('/w2', row.run_id)
    shown.campaign.fail(row, 'the disk is full')
    shown.dashboard.end('/w2', 'failed', done=False)
    shown.dashboard.close()
    screen = shown.text.getvalue()
    assert '4 runs: 0 done, 1 failed, 1 running, 2 due' in screen
    assert '▁' in screen
    assert '█' in screen
    assert 'r4 failed: the disk is full' in screen
    assert '5/20 episodes' in screen
