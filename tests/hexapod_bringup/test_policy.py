# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The SROS 2 policy allows every endpoint that docs/interfaces.md lists of the nodes in it."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
POLICY = ROOT / 'ros_ws/src/hexapod_bringup/config/policy.xml'
PROFILES = [
    (enclave.get('path', ''), profile)
    for enclave in ElementTree.parse(POLICY).iter('enclave')
    for profile in enclave.iter('profile')
]
RIGHTS = {
    'publishes': ('topics', 'publish'),
    'subscribes': ('topics', 'subscribe'),
    'serves': ('services', 'reply'),
    'calls': ('services', 'request'),
    'action': ('actions', 'execute'),
}


def listed(node: str) -> list[tuple[str, str]]:
    """Return kind and name of the endpoints in a node's table."""
    page = (ROOT / 'docs' / 'interfaces.md').read_text(encoding='utf-8')
    table = page.partition(f'## `{node}`: ')[2].partition('| parameter |')[0]
    return re.findall(r'\| (publishes|subscribes|calls|serves|action) \| `([^`]+)`', table)


def allowed(profile: ElementTree.Element, tag: str, right: str) -> set[str | None]:
    groups = [group for group in profile.findall(tag) if group.get(right) == 'ALLOW']
    return {item.text for group in groups for item in group}


@pytest.mark.parametrize(
    ('enclave', 'profile'), PROFILES, ids=lambda v: v if isinstance(v, str) else v.get('node')
)
def test_what_a_node_has_is_allowed(enclave: str, profile: ElementTree.Element) -> None:
    node = profile.get('node', '')
    endpoints = listed(node)
    assert endpoints, enclave
    for kind, name in endpoints:
        assert name in allowed(profile, *RIGHTS[kind]), (node, kind, name)
    assert f'{node}/set_parameters' in allowed(profile, 'services', 'reply')
    assert '/rosout' in allowed(profile, 'topics', 'publish')


def test_the_manager_alone_may_ask_a_worker_to_train() -> None:
    asking = {
        profile.get('node') for _, profile in PROFILES if allowed(profile, 'actions', 'call')
    }
    assert asking == {'manager'}
