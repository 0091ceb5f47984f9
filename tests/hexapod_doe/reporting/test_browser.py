# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A real browser draws the report at desk and phone width, in light and dark, without an error.

It is driven over the WebDriver protocol, so that no browser library is needed.
"""

import json
import shutil
import socket
import subprocess
import time
from urllib.error import URLError
from urllib.request import Request, urlopen

import pytest

BROWSER = next(
    filter(None, map(shutil.which, ('chromium', 'chromium-browser', 'google-chrome'))), ''
)
DRIVER = shutil.which('chromedriver')
pytestmark = pytest.mark.skipif(
    not (BROWSER and DRIVER), reason='needs chromium and chromedriver on the path'
)

FLAGS = [
    '--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run',
    '--disable-background-networking', '--disable-component-update', '--disable-sync',
]  # fmt: skip

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


class Browser:
    """A session of a headless browser."""

    def __init__(self, profile):
        with socket.socket() as probe:
            probe.bind(('127.0.0.1', 0))
            port = probe.getsockname()[1]
        self._base = f'http://127.0.0.1:{port}'
        self._process = subprocess.Popen([DRIVER, f'--port={port}'], stdout=subprocess.DEVNULL)
        self._wait()
        options = {'binary': BROWSER, 'args': [*FLAGS, f'--user-data-dir={profile}']}
        wanted = {
            'goog:chromeOptions': options,
            'goog:loggingPrefs': {'browser': 'ALL', 'performance': 'ALL'},
        }
        session = self._send('/session', {'capabilities': {'alwaysMatch': wanted}})
        self._base += f'/session/{session["sessionId"]}'

    def _wait(self):
        for _ in range(100):
            try:
                urlopen(f'{self._base}/status', timeout=5).close()
            except URLError:
                time.sleep(0.1)
            else:
                return
        raise TimeoutError(f'chromedriver did not answer at {self._base}')

    def _send(self, path, body, method='POST'):
        data = None if body is None else json.dumps(body).encode()
        request = Request(self._base + path, data, method=method)
        request.add_header('Content-Type', 'application/json')
        with urlopen(request, timeout=120) as answer:
            return json.load(answer)['value']

    def command(self, name, **parameters):
        """Run a command of the developer tools."""
        return self._send('/goog/cdp/execute', {'cmd': name, 'params': parameters})

    def open(self, page, width, theme):
        """Open a page at a width and in a theme, and return what it measures."""
        self.command(
            'Emulation.setDeviceMetricsOverride',
            width=width, height=900, deviceScaleFactor=1, mobile=width < 600,
        )  # fmt: skip
        scheme = {'name': 'prefers-color-scheme', 'value': theme}
        self.command('Emulation.setEmulatedMedia', features=[scheme])
        self._send('/url', {'url': page.as_uri()})
        return self._send('/execute/sync', {'script': MEASURE, 'args': []})

    def log(self, kind):
        """Return the entries of a log since it was last read."""
        return self._send('/se/log', {'type': kind})

    def close(self):
        """End the session and the driver."""
        self._send('', None, 'DELETE')
        self._process.terminate()
        self._process.wait(10)


@pytest.fixture(scope='module')
def browser(tmp_path_factory):
    """A browser with an empty profile."""
    session = Browser(tmp_path_factory.mktemp('profile'))
    yield session
    session.close()


@pytest.mark.parametrize('theme', ['light', 'dark'])
@pytest.mark.parametrize('width', [1280, 390])
@pytest.mark.parametrize('report', ['tour_page', 'campaign_page'])
def test_the_report_is_drawn(request, browser, report, width, theme):
    page = request.getfixturevalue(report)
    found = browser.open(page, width, theme)
    assert found['figures'] >= 10
    assert len(found['sizes']) == found['figures']
    assert all(w > 250 and h > 100 for w, h in found['sizes'])
    assert all(marks > 5 for marks in found['marks'])
    assert found['smallest'] >= 9  # px, the height of the smallest text
    assert found['overflow'] <= 0
    dark = theme == 'dark'
    assert found['background'] == ('rgb(18, 22, 28)' if dark else 'rgb(254, 254, 254)')
    errors = [entry for entry in browser.log('browser') if entry['level'] != 'INFO']
    assert not errors
    assert _requests(browser, page) - {'data:,'} == {page.as_uri()}


def _requests(browser, page):
    """Return the addresses of everything that the page requested."""
    messages = (json.loads(entry['message'])['message'] for entry in browser.log('performance'))
    sent = [m['params'] for m in messages if m['method'] == 'Network.requestWillBeSent']
    return {p['request']['url'] for p in sent if p['documentURL'] == page.as_uri()}
