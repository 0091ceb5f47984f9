# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Every test process has a ROS domain of its own, strict message fields and its own logs."""

import gc
import os
import signal
import socket
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hexapod_node.participants import participants_here
from hypothesis import settings

# The port says which domain is taken, to every test process of this machine: the same one that
# ROS's own domain_coordinator binds.
_PORT_BASE = 32768
_LAST_DOMAIN = 101


# For every way to start the tests: from the root, or by `colcon test` for one package.
_MARKERS = (
    'graph: starts rclpy nodes inside the test process',
    'system: starts nodes as processes of their own',
    'slow: a proof of minutes; run by make test-slow',
    'alone: judges how long something takes; no test runs beside it',
)
# Folders whose tests wait a lot, by which several workers should begin.
_FIRST = ('system', 'graph', 'docs')

# What several tests share, and who reads the documentation runs, lies there.
sys.path.insert(0, str(Path(__file__).parent / 'support'))


def pytest_configure(config: pytest.Config) -> None:
    """Make the marks of the tests known, and have workers take turns (`make test`)."""
    for marker in _MARKERS:
        config.addinivalue_line('markers', marker)
    if hasattr(config, 'workerinput'):  # a worker of pytest-xdist; their folders lie side by side
        from turns import Turns

        config.pluginmanager.register(Turns(Path(config.option.basetemp).parent / 'turns'))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with what takes longest, so that no worker is left with it at the end."""
    ranks = {folder: rank for rank, folder in enumerate(_FIRST)}
    items.sort(key=lambda item: ranks.get(item.path.parent.name, len(ranks)))


def pytest_collection_finish() -> None:
    """Spare the garbage collector what lives as long as the run: modules and collected tests.

    There are millions of objects, and to look through them takes a second. Tests of the graph
    collect after each of them, and so does statsmodels in every correction of p-values.
    """
    gc.collect()
    gc.freeze()


def _reserve_domain() -> tuple[int, socket.socket]:
    """Return a ROS domain that no test process has and no node is in, and what holds it."""
    for domain in range(1, _LAST_DOMAIN + 1):
        holder = socket.socket()
        try:
            holder.bind(('127.0.0.1', _PORT_BASE + domain))
        except OSError:
            holder.close()
            continue
        if participants_here(domain):  # nodes of somebody else, or those that a killed test left
            holder.close()
            continue
        return domain, holder
    raise RuntimeError(f'no free ROS domain from 1 to {_LAST_DOMAIN}: end other test runs')


# A job that a shell keeps in the background ignores SIGINT, and so would whatever a test starts.
signal.signal(signal.SIGINT, signal.default_int_handler)

# A busy machine is slow, not wrong.
settings.register_profile('shared_machine', deadline=None, derandomize=True)
settings.load_profile('shared_machine')

# Before anything imports rclpy: it reads the first two once.
os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'
os.environ['ROS_LOG_DIR'] = tempfile.mkdtemp(prefix='hexapod_ros_log_')
os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
os.environ['OMP_NUM_THREADS'] = '1'
_domain, _domain_holder = _reserve_domain()
os.environ['ROS_DOMAIN_ID'] = str(_domain)


@pytest.fixture(autouse=True)
def _no_node_outlives_its_test(request: pytest.FixtureRequest) -> Iterator[None]:
    """Free a test's nodes when it ends, not whenever Python next looks for cycles.

    Until then they are peers of the next test's nodes. Fast DDS 2.14 delivers to peers of the same
    process through plain pointers, so freeing them amid traffic can crash the process.
    """
    yield
    if request.node.get_closest_marker('graph'):
        gc.collect()


@pytest.fixture(scope='module')
def own_domain() -> Iterator[int]:
    """Give a module's processes a domain that nodes of this test process were never in.

    A node of an earlier test leaves the graph when Python frees its last handle, which may be
    later than the test's end.
    """
    domain, holder = _reserve_domain()
    before = os.environ['ROS_DOMAIN_ID']
    os.environ['ROS_DOMAIN_ID'] = str(domain)
    yield domain
    os.environ['ROS_DOMAIN_ID'] = before
    holder.close()


@pytest.fixture
def told() -> Callable[[str], list[str]]:
    """Yield what splits an output into the lines that a node itself has written.

    Fast DDS complains on the terminal about shared memory that killed processes left behind, and
    goes on without; a worker tells how much of it was freed.
    """
    others = ('RTPS_TRANSPORT_SHM', 'shared memory that killed nodes had left')
    return lambda output: [
        line for line in output.strip().splitlines() if not any(text in line for text in others)
    ]


@pytest.fixture(scope='session')
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """A `browser.Browser` with an empty profile; tests that ask for it bear `needs_browser`."""
    from browser import Browser

    session = Browser(tmp_path_factory.mktemp('profile'))
    yield session
    session.close()
