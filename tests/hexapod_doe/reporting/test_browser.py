# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A real browser draws the report at desk and phone width, in light and dark, without an error."""

from typing import Any

import pytest
from browser import Browser, in_every_look, needs_browser

pytestmark = needs_browser

MEASURE = """
const drawings = [...document.querySelectorAll('.drawing svg')];
const shown = drawings.filter(s => s.getClientRects().length);
return {
  figures: document.querySelectorAll('figure').length,
  sizes: shown.map(s => [s.getBoundingClientRect().width, s.getBoundingClientRect().height]),
  marks: shown.map(s => s.querySelectorAll('path, use').length),
  smallest: Math.min(...shown.flatMap(s =>
    [...s.querySelectorAll('text')].map(t => t.getBoundingClientRect().height))),
  overflow: document.documentElement.scrollWidth - document.documentElement.clientWidth,
  background: getComputedStyle(document.body).backgroundColor,
  ink: getComputedStyle(shown[0].querySelector('text')).fill,
};
"""


@in_every_look
@pytest.mark.parametrize('report', ['tour_page', 'campaign_page'])
def test_the_report_is_drawn(
    request: Any, browser: Browser, report: str, width: int, theme: str
) -> None:
    page = request.getfixturevalue(report)
    browser.open(page.as_uri(), width, theme)
    found = browser.run(MEASURE)
    assert found['figures'] >= 10
    assert len(found['sizes']) == found['figures']
    assert all(w > 250 and h > 100 for w, h in found['sizes'])
    assert all(marks > 5 for marks in found['marks'])
    assert found['smallest'] >= 9  # px, the height of the smallest text
    assert found['overflow'] <= 0
    dark = theme == 'dark'
    assert found['background'] == ('rgb(18, 22, 28)' if dark else 'rgb(254, 254, 254)')
    assert not browser.complaints()
    assert browser.requests() == {page.as_uri()}
