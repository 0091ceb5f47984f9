# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a run is judged by, of its bag's episodes and its evaluation's."""

from dataclasses import replace

import pandas as pd
import pytest
from hexapod_doe.bags.run_record import RunRecord
from hexapod_doe.errors import AnalysisError, BagError
from hexapod_doe.tables.bag_response import RESPONSES, default_response, response_of

RETURNS = [0.0, 12.0, 6.0, 3.0, 1.0, 8.0]


def run(window: int | None) -> RunRecord:
    episodes = pd.DataFrame(
        {
            'episode_return': RETURNS,
            'average_return': [0.0, 6.0, 6.0, 5.25, 5.5, 4.5],
            'term_velocity': [2.0, 4.0, 6.0, 8.0, 10.0, 12.0],
        }
    )
    return RunRecord('r1', {} if window is None else {'window': str(window)}, episodes)


def judged(run_id: str = 'r1') -> RunRecord:
    """A run with an evaluation of three episodes."""
    evaluation = pd.DataFrame(
        {
            'episode_return': [3.0, 4.0, 8.0],
            'average_return': [3.0, 3.5, 5.0],
            'term_velocity': [1.0, 2.0, 6.0],
            'terminated': [False, True, True],
        }
    )
    return replace(run(4), run_id=run_id, evaluation=evaluation)


@pytest.mark.parametrize(
    ('name', 'expected'),
    [
        ('evaluation_return', 5.0),
        ('evaluation_falls', 2.0),
        ('evaluation_term_velocity', 3.0),
        ('term_velocity', 9.0),  # of the training's last four
    ],
)
def test_responses_of_an_evaluation(name: str, expected: float) -> None:
    assert response_of(judged(), name) == expected


def test_a_run_without_an_evaluation_has_no_such_response() -> None:
    for name in ('evaluation_return', 'evaluation_term_velocity'):
        with pytest.raises(AnalysisError, match=r'r1 has no evaluation.*--response final_average'):
            response_of(run(4), name)


def test_the_evaluation_is_the_default_where_each_run_has_one() -> None:
    assert default_response([judged(), judged('r2')]) == 'evaluation_return'
    assert default_response([run(4), run(4)]) == 'final_average_reward'
    with pytest.raises(AnalysisError, match=r'1 of 2 runs have no evaluation \(r1\).*--response'):
        default_response([run(4), judged('r2')])


@pytest.mark.parametrize(
    ('name', 'window', 'expected'),
    [
        ('final_average_reward', 4, 4.5),  # as the agent kept it
        ('best_average_reward', 2, 9.0),  # (12 + 6)/2
        ('best_average_reward', 250, 5.0),  # fewer than a window: all, 30/6
        ('final_iqm_reward', 4, 4.5),  # of 1 3 6 8 the middle two
        (
            'final_iqm_reward',
            250,
            13.5 / 3,
        ),  # of 0 1 3 6 8 12 from 1.5 to 4.5: half 1, 3, 6, half 8
        ('mean_return', 4, 5.0),
        ('term_velocity', 3, 10.0),
    ],
)
def test_responses(name: str, window: int, expected: float) -> None:
    assert response_of(run(window), name) == pytest.approx(expected)


def test_the_share_that_recovers_is_a_response_of_varied_robots() -> None:
    varied = judged()
    varied.evaluation['recovered'] = [1.0, 0.0, 1.0]
    assert response_of(varied, 'evaluation_recovered') == pytest.approx(2 / 3)
    varied.evaluation['recovered'] = [float('nan')] * 3
    with pytest.raises(AnalysisError, match="response 'evaluation_recovered': run r1 has"):
        response_of(varied, 'evaluation_recovered')


def test_an_unknown_response_is_an_error_that_names_the_known_ones() -> None:
    with pytest.raises(AnalysisError, match=f"'speed': run r1 has {', '.join(RESPONSES)}, term_v"):
        response_of(run(4), 'speed')


def test_a_window_that_the_bag_lacks_is_not_guessed() -> None:
    assert response_of(run(None), 'final_average_reward') == 4.5
    with pytest.raises(BagError, match='run r1: its metadata lacks the window'):
        response_of(run(None), 'best_average_reward')
