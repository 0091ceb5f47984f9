# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Sets stand by the model that the choice is made from."""

from hexapod_doe.reporting.standing import deciding_parts, standings


def test_failures_let_the_two_part_model_decide(campaign):
    found = standings(campaign)
    assert deciding_parts(campaign) is campaign.two_part is not None
    assert [s.label for s in found] == list(campaign.two_part.ranking)
    assert found[0].label == campaign.choice
    assert found[0].value == campaign.two_part.selected[campaign.choice]
    assert found[0].ci == campaign.two_part.expected[campaign.choice].ci


def test_the_articles_procedure_decides_by_its_final_model(article):
    found = standings(article)
    assert deciding_parts(article) is None
    assert [s.label for s in found] == list(article.ranking)
    assert [s.value for s in found] == [p.fit for p in article.ranked()]


def test_every_set_stands_once_best_first(campaign, article, tour):
    for analysis in (campaign, article, tour):
        found = standings(analysis)
        assert [s.rank for s in found] == list(range(1, 129))
        assert len({s.label for s in found}) == 128
        values = [s.value for s in found]
        assert values == sorted(values, reverse=True)
        assert sum(s.tested for s in found) == analysis.design.cases
