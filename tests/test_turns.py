# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Tests of several processes run beside each other, and a test that wants to be alone is."""

import threading
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path

import pytest
from turns import Turns


def test_several_are_inside_at_once(tmp_path: Path) -> None:
    with Turns(tmp_path).taken(alone=False), Turns(tmp_path).taken(alone=False):
        pass  # would wait for ever


def test_one_that_is_alone_waits_for_those_inside_and_comes_before_later_ones(
    tmp_path: Path,
) -> None:
    order: list[str] = []
    entered = threading.Event()

    def take(name: str, alone: bool) -> None:
        with Turns(tmp_path).taken(alone):
            order.append(name)
            entered.set()

    with ThreadPoolExecutor() as pool, ExitStack() as inside:
        inside.enter_context(Turns(tmp_path).taken(alone=False))
        alone = pool.submit(take, 'alone', True)
        assert not entered.wait(0.2)
        later = pool.submit(take, 'later', False)
        assert not entered.wait(0.2)
        inside.close()
        alone.result(30.0)
        later.result(30.0)
    assert order == ['alone', 'later']


def test_the_place_of_a_test_that_fails_is_free(tmp_path: Path) -> None:
    with pytest.raises(KeyError), Turns(tmp_path).taken(alone=True):
        raise KeyError
    with Turns(tmp_path).taken(alone=True):
        pass
