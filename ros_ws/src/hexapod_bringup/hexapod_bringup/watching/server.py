# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Serves the page to browsers of this machine: one file, and a stream of events for each page."""

import base64
import hashlib
import json
import re
import threading
import time
from collections.abc import Callable
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

from hexapod_bringup.watching.board import Board, Seen
from hexapod_bringup.watching.campaigns import CampaignReader
from hexapod_bringup.watching.signals import panels
from hexapod_bringup.watching.studio import Studio

LOCAL = ('127.0.0.1', 'localhost', '::1')
_PERIOD_S = 0.2
_CAMPAIGN_PERIOD_S = 3.0


def page() -> str:
    """Return the page."""
    return (files('hexapod_bringup.watching') / 'page.html').read_text(encoding='utf-8')


def policy(html: str) -> str:
    """Return what a browser may do for the page: its own script and style, and the stream."""
    parts = {'script-src': 'script', 'style-src': 'style'}
    allowed = {
        name: ' '.join(_digest(text) for text in re.findall(f'<{tag}>(.*?)</{tag}>', html, re.S))
        for name, tag in parts.items()
    }
    rules = [f'{name} {digests}' for name, digests in allowed.items()]
    others = ["default-src 'none'", "connect-src 'self'", 'img-src data:', "base-uri 'none'"]
    return '; '.join([*others, *rules, "form-action 'none'", "frame-ancestors 'none'"])


def _digest(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


class CampaignNews:
    """The campaign's record for every page, read no more often than it is worth."""

    def __init__(self, folder: Callable[[], Path | None]) -> None:
        self._folder = folder
        self._lock = threading.Lock()
        self._reader = CampaignReader()
        self._due = 0.0
        self._record: dict[str, Any] | None = None
        self._number = 0

    def since(self, number: int) -> tuple[int, dict[str, Any] | None]:
        """Return the record's number, and the record if it is a newer one."""
        with self._lock:
            folder = self._folder()
            if folder is not None and time.monotonic() >= self._due:
                record = self._reader.read(folder)
                self._due = time.monotonic() + _CAMPAIGN_PERIOD_S
                if record != self._record:
                    self._record, self._number = record, self._number + 1
            return self._number, self._record if self._number > number else None


class PageServer(ThreadingHTTPServer):
    """Answers browsers until it is closed."""

    daemon_threads = True
    block_on_close = False

    def __init__(self, host: str, port: int, board: Board, studio: Studio) -> None:
        """Take the address.

        Args:
            host: name or address to listen at.
            port: 0 for any that is free.
            board: what was heard.
            studio: draws the pictures.

        Raises:
            OSError: the address is taken, or none of this machine.
        """
        self.board, self.studio = board, studio
        self.campaign = CampaignNews(self._folder)
        self.closing = threading.Event()
        self.html = page()
        self.policy = policy(self.html)
        super().__init__((host, port), _Handler)
        self.is_local = host in LOCAL
        self._thread = threading.Thread(target=self.serve_forever, name='server', daemon=True)

    @property
    def address(self) -> str:
        """What to open."""
        host, port = self.server_address[:2]
        return f'http://{host!s}:{port}/'

    def start(self) -> None:
        """Begin to answer."""
        self._thread.start()

    def close(self) -> None:
        """End the streams and free the address."""
        self.closing.set()
        self.shutdown()
        self.server_close()

    def _folder(self) -> Path | None:
        with self.board.lock:
            folder = self.board.campaign_folder
        return Path(folder) if folder else None


class _Handler(BaseHTTPRequestHandler):
    server: PageServer
    protocol_version = 'HTTP/1.1'

    def do_GET(self) -> None:
        address = urlsplit(self.path)
        if self.server.is_local and self._host() not in LOCAL:
            # A page of elsewhere whose name was made to mean this machine.
            self.send_error(HTTPStatus.FORBIDDEN, 'expected to be asked as localhost')
        elif address.path == '/':
            self._send_page()
        elif address.path == '/events':
            query = parse_qs(address.query)
            self._stream(query.get('robot', [''])[0], query.get('every', ['0'])[0] == '1')
        else:
            self.send_error(HTTPStatus.NOT_FOUND)

    def _host(self) -> str:
        return (urlsplit(f'//{self.headers.get("Host", "")}').hostname or '').lower()

    def _send_page(self) -> None:
        body = self.server.html.encode()
        self.send_response(HTTPStatus.OK)
        self.send_header('Content-Type', 'text/html; charset=utf-8')
        self.send_header('Content-Length', str(len(body)))
        self.send_header('Content-Security-Policy', self.server.policy)
        self.send_header('Cache-Control', 'no-store')
        self.end_headers()
        self.wfile.write(body)

    def _stream(self, robot: str, every: bool) -> None:
        """Send what is new, until the page is closed or the server is."""
        self.close_connection = True
        self.send_response(HTTPStatus.OK)
        self.send_header('Content-Type', 'text/event-stream')
        self.send_header('Cache-Control', 'no-store')
        self.end_headers()
        feed = Feed(self.server, robot)
        try:
            with self.server.board.watching(robot, every):
                while not self.server.closing.is_set():
                    self.wfile.write(f'data: {json.dumps(feed.next())}\n\n'.encode())
                    self.wfile.flush()
                    self.server.closing.wait(_PERIOD_S)
        except (BrokenPipeError, ConnectionError):
            pass  # the page was closed

    def log_message(self, *_: Any) -> None:
        """Say nothing of requests."""


class Feed:
    """What one page is told next."""

    def __init__(self, server: PageServer, robot: str) -> None:
        self._server, self._robot = server, robot
        self._seen = Seen()
        self._picture: bytes | None = None
        self._campaign = 0
        self._first: dict[str, Any] = {'panels': panels()}

    def next(self) -> dict[str, Any]:
        """Return the next event."""
        told = {**self._first, **self._server.board.news(self._robot, self._seen)}
        self._first = {}
        picture = self._server.studio.picture(self._robot)
        if picture is not None and picture is not self._picture:
            self._picture = picture
            told['picture'] = base64.b64encode(picture).decode()
        if self._server.studio.fault:
            told['no_picture'] = self._server.studio.fault
        self._campaign, record = self._server.campaign.since(self._campaign)
        if record is not None:
            told['campaign'] = record
        return told
