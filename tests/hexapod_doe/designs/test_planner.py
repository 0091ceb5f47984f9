# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Proposals stay within their budget and say what they cannot do."""

import pytest
from hexapod_doe.designs.planner import Budget, describe, options, propose
from hypothesis import given, settings
from hypothesis import strategies as st


def test_the_articles_campaign_needs_its_hours():
    # 32 cases x 10 replicates x 1000 episodes of 2.5 s on two workers: 111.1 h.
    assert Budget(1, 2.5, 2).hours_for(320_000) == pytest.approx(111.111, abs=1e-3)


def test_plenty_of_hours_buy_a_design_without_confounded_pairs():
    chosen = propose(options(Budget(hours=800, seconds_per_episode=2.5, workers=2)))
    assert chosen.design.name == 'half'
    assert chosen.separable == 28
    assert chosen.sees <= 0.32
    assert chosen.hours < 800
    assert 'Cannot separate' not in describe(chosen)


def test_fewer_hours_buy_a_coarser_design_with_replicates():
    chosen = propose(options(Budget(hours=25, seconds_per_episode=2.5, workers=2)))
    assert (chosen.design.name, chosen.replicates) == ('quarter', 2)
    assert 'Cannot separate: CE + FG; CF + EG; CG + EF.' in describe(chosen)


def test_too_few_hours_are_called_a_tour():
    # The demo: 16 cases x 4 episodes of 15 s.
    chosen = propose(options(Budget(hours=64 * 15 / 3600, seconds_per_episode=15)))
    text = describe(chosen)
    assert (chosen.design.name, chosen.replicates, chosen.episodes) == ('eighth', 1, 4)
    assert '4 of 1000 episodes' in text
    assert 'a tour, not a conclusion' in text
    assert 'One replicate' in text


def test_a_known_deviation_gives_reward_units():
    chosen = propose(options(Budget(800, 2.5, 2)))
    assert f'{chosen.sees * 170:.3g} reward units' in describe(chosen, sigma=170)


@settings(max_examples=30, deadline=None)
@given(st.floats(1, 500), st.floats(0.5, 30), st.integers(1, 8), st.integers(3, 8))
def test_every_option_fits_its_budget(hours, seconds, workers, factors):
    budget = Budget(hours, seconds, workers)
    found = options(budget, factors, episodes=200)
    assert propose(found) in found
    for option in found:
        assert option.hours <= hours * (1 + 1e-9)
        assert 1 <= option.episodes <= 200


def test_impossible_budgets_are_named():
    with pytest.raises(ValueError, match='hours 0: expected a positive'):
        Budget(0, 1)
    with pytest.raises(ValueError, match=r'not one per case; expected at least 0\.044 h'):
        options(Budget(hours=0.01, seconds_per_episode=10))
