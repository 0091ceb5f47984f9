# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The one place of every number of a run: article.yaml, of which each package reads its sections.

It stands in the package that all others build on. No dataclass has a default of its own.
"""

from collections.abc import Mapping
from functools import lru_cache
from importlib.resources import files
from types import MappingProxyType
from typing import Any

import yaml

ARTICLE = 'article.yaml'


def article_text() -> str:
    """Return article.yaml as it is written, with the origin of each value."""
    return (files('hexapod_sim') / ARTICLE).read_text(encoding='utf-8')


@lru_cache(maxsize=1)
def article() -> Mapping[str, Any]:
    """Return the values of article.yaml by section."""
    return MappingProxyType(yaml.safe_load(article_text()))


def section(*keys: str) -> dict[str, Any]:
    """Return a section of article.yaml as keyword arguments; a list of numbers is a tuple.

    Args:
        *keys: Names of the sections that lead to it.
    """
    found: Any = article()
    for key in keys:
        found = found[key]
    return {
        name: tuple(value) if isinstance(value, list) else value for name, value in found.items()
    }
