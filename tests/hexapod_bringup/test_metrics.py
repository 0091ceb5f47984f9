# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A new metric is one entry of one table: whatever shows metrics shows it."""

import json
import math

import numpy as np
from hexapod_agent.learning import metrics
from hexapod_agent.learning.event_log import scalars
from hexapod_agent.learning.metrics import METRICS, Metric
from hexapod_agent.learning.summary import EpisodeRecord
from hexapod_doe.reporting.glossary import meanings
from hexapod_sim.task import Outcome
from interface_tables import metric_table
from layouts import foxglove, plotjuggler

LAST = Outcome(600, 1.0, {}, False, True, 'time_limit')


def test_a_new_name_is_everywhere(monkeypatch) -> None:
    new = Metric('joint_work', 'J', 'work of all joints', plot='work (J)')
    monkeypatch.setattr(metrics, 'METRICS', (*METRICS, new))
    summary = EpisodeRecord(0).summarize(LAST, 1.0)
    assert math.isnan(summary.metrics['joint_work'])
    place = list(summary.metrics).index('joint_work')
    assert 'learner/joint_work' in scalars(summary)
    assert meanings()['joint_work'] == 'work of all joints, in J'
    assert '| `joint_work` | J | work of all joints |' in metric_table()
    panels = json.loads(foxglove('w'))['configById'].values()
    work = next(panel for panel in panels if panel.get('title') == 'work (J)')
    assert work['paths'][0]['value'] == f'/w/episode_result.metric_values[{place}]'
    assert f'name="/w/episode_result/metric_values[{place}]"' in plotjuggler('w')


def test_an_episode_reports_means_over_its_updates_and_names_of_a_learners_own() -> None:
    record = EpisodeRecord(0, ['critic_loss', 'entropy'])
    assert math.isnan(record.summarize(LAST, 1.0).metrics['entropy'])
    record.add_updates({'critic_loss': np.full(2, 0.5), 'entropy': np.array([1.0, 2.0])})
    found = record.summarize(LAST, 1.0).metrics
    assert list(found)[: len(METRICS)] == [metric.name for metric in METRICS]
    assert (found['critic_loss'], found['entropy'], found['updates']) == (0.5, 1.5, 2.0)


def test_no_metric_has_the_name_of_a_field_of_the_episode() -> None:
    assert not {metric.name for metric in METRICS} & set(
        vars(EpisodeRecord(0).summarize(LAST, 1.0))
    )
