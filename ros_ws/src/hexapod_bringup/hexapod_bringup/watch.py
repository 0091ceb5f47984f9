# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `watch`: a page of this machine that shows robots and a campaign while they run.

It shows film, reward, sensors and learning curves of every worker that is found in the ROS domain,
and costs a worker nothing while no page is open. The page needs neither a network nor an account.
"""

import os
import sys
import webbrowser
from collections.abc import Sequence

from hexapod_doe.campaigns.campaign import PLAN_FILE
from hexapod_node.spin import run
from hexapod_sim.command_line import CommandLine, folder, one_line, whole

from hexapod_bringup.watch_node import WatchNode
from hexapod_bringup.watching.board import Board
from hexapod_bringup.watching.server import LOCAL, PageServer
from hexapod_bringup.watching.studio import Studio

PORT = 8090
_ROS_ARGS = '--ros-args'
_POLITENESS = 5  # of 19: what is watched goes before the watch


def main(arguments: Sequence[str] | None = None) -> None:
    """Serve the page until a signal comes; what follows `--ros-args` goes to the node."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    count = words.index(_ROS_ARGS) if _ROS_ARGS in words else len(words)
    parser = _parser()
    options = parser.parse_args(words[:count])
    if options.campaign and not (options.campaign / PLAN_FILE).is_file():
        parser.error(
            f'{options.campaign}: no {PLAN_FILE} in it, expected the folder of a campaign'
        )
    board = Board()
    studio = Studio(board)
    try:
        server = PageServer(options.host, options.port, board, studio)
    except OSError as error:
        parser.error(
            f'{options.host}:{options.port}: {one_line(error)}, expected an address of this '
            'machine and a free port; --port 0 takes any'
        )
    os.nice(_POLITENESS)
    studio.start()
    server.start()
    _tell(server, options.open)
    try:
        run(lambda: WatchNode(board, options.campaign), words[count:])
    finally:
        server.close()
        studio.close()


def _tell(server: PageServer, may_open: bool) -> None:
    print(f'watch: open {server.address} in a browser; Ctrl-C ends it', flush=True)
    if not server.is_local:
        print('watch: whoever reaches this address may look', file=sys.stderr, flush=True)
    has_display = sys.platform == 'darwin' or {'DISPLAY', 'WAYLAND_DISPLAY'} & os.environ.keys()
    if may_open and has_display and sys.stdout.isatty():
        webbrowser.open(server.address)


def _parser() -> CommandLine:
    parser = CommandLine(prog='watch', description=__doc__)
    add = parser.add_argument
    add('campaign', nargs='?', type=folder, help="campaign's folder; by default the manager's")
    add('--port', type=whole(0, 65535), default=PORT, help=f'of the page (default {PORT})')
    add('--host', default=LOCAL[0], help='address to listen at; this machine alone by default')
    add('--no-open', dest='open', action='store_false', help='open no browser')
    return parser


if __name__ == '__main__':
    main()
