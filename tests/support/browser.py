# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A real browser for tests, driven over the WebDriver protocol: no browser library is needed."""

import base64
import json
import shutil
import socket
import subprocess
import time
from pathlib import Path
from typing import Any
from urllib.error import URLError
from urllib.request import Request, urlopen

import pytest

BROWSER = next(
    filter(None, map(shutil.which, ('chromium', 'chromium-browser', 'google-chrome'))), ''
)
DRIVER = shutil.which('chromedriver') or ''
SIZES = {'desktop': 1280, 'phone': 390}
"""Widths of windows, pixels."""
THEMES = ('light', 'dark')

needs_browser = pytest.mark.skipif(
    not (BROWSER and DRIVER), reason='needs chromium and chromedriver on the path'
)
in_every_look = pytest.mark.parametrize(
    ('width', 'theme'),
    [(width, theme) for width in SIZES.values() for theme in THEMES],
    ids=[f'{size}-{theme}' for size in SIZES for theme in THEMES],
)

_FLAGS = [
    '--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run',
    '--disable-background-networking', '--disable-component-update', '--disable-sync',
]  # fmt: skip
OVERFLOW = 'document.documentElement.scrollWidth - document.documentElement.clientWidth'
"""JavaScript: by how many pixels a page is wider than its window."""


class Browser:
    """A session of a headless browser."""

    def __init__(self, profile: Path) -> None:
        """Begin with an empty profile, which lies in that folder."""
        with socket.socket() as probe:
            probe.bind(('127.0.0.1', 0))
            port = probe.getsockname()[1]
        self._base = f'http://127.0.0.1:{port}'
        self._process = subprocess.Popen([DRIVER, f'--port={port}'], stdout=subprocess.DEVNULL)
        self._wait()
        options = {'binary': BROWSER, 'args': [*_FLAGS, f'--user-data-dir={profile}']}
        wanted = {
            'goog:chromeOptions': options,
            'goog:loggingPrefs': {'browser': 'ALL', 'performance': 'ALL'},
        }
        session = self._send('/session', {'capabilities': {'alwaysMatch': wanted}})
        self._base += f'/session/{session["sessionId"]}'

    def _wait(self) -> None:
        for _ in range(100):
            try:
                urlopen(f'{self._base}/status', timeout=5).close()
            except URLError:
                time.sleep(0.1)
            else:
                return
        raise TimeoutError(f'chromedriver did not answer at {self._base}')

    def _send(self, path: str, body: Any, method: str = 'POST') -> Any:
        data = None if body is None else json.dumps(body).encode()
        request = Request(self._base + path, data, method=method)
        request.add_header('Content-Type', 'application/json')
        with urlopen(request, timeout=120) as answer:
            return json.load(answer)['value']

    def _command(self, name: str, **parameters: Any) -> Any:
        """Run a command of the developer tools."""
        return self._send('/goog/cdp/execute', {'cmd': name, 'params': parameters})

    def open(self, address: str, width: int, theme: str) -> None:
        """Open a page at a width and in a theme; what was logged before it is forgotten."""
        self._command(
            'Emulation.setDeviceMetricsOverride',
            width=width, height=900, deviceScaleFactor=1, mobile=width < 600,
        )  # fmt: skip
        scheme = {'name': 'prefers-color-scheme', 'value': theme}
        self._command('Emulation.setEmulatedMedia', features=[scheme])
        self._send('/url', {'url': 'about:blank'})
        self._log('browser'), self._log('performance')
        self._send('/url', {'url': address})

    def run(self, script: str) -> Any:
        """Run the body of a JavaScript function and return what it does."""
        return self._send('/execute/sync', {'script': script, 'args': []})

    def wait_for(self, expression: str, timeout_s: float = 30.0) -> None:
        """Wait until a JavaScript expression is true."""
        deadline = time.monotonic() + timeout_s
        while not self.run(f'return Boolean({expression});'):
            assert time.monotonic() < deadline, f'{expression} within {timeout_s} s'
            time.sleep(0.1)

    def complaints(self) -> list[Any]:
        """Return what the console has had since it was last read, information apart."""
        return [entry for entry in self._log('browser') if entry['level'] != 'INFO']

    def requests(self) -> set[str]:
        """Return the addresses of everything that was requested since this was last read."""
        messages = (json.loads(entry['message'])['message'] for entry in self._log('performance'))
        sent = [m['params'] for m in messages if m['method'] == 'Network.requestWillBeSent']
        addresses = {each['request']['url'] for each in sent}
        return {address for address in addresses if not address.startswith(('data:', 'about:'))}

    def screenshot(self, path: Path) -> None:
        """Write what the window shows as a PNG."""
        shot = self._command('Page.captureScreenshot', captureBeyondViewport=True)
        path.write_bytes(base64.b64decode(shot['data']))

    def _log(self, kind: str) -> Any:
        return self._send('/se/log', {'type': kind})

    def close(self) -> None:
        """End the session and the driver."""
        self._send('', None, 'DELETE')
        self._process.terminate()
        self._process.wait(10)
