# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Joint arrays are matched by name, whatever order, prefix or further joints a driver has."""

import numpy as np
import pytest
from hexapod_sim.joint_names import by_joint, joint_order, joint_prefix
from hexapod_sim.robot import JOINTS
from hypothesis import given
from hypothesis import strategies as st


@given(
    st.permutations([*JOINTS, 'gripper', 'pan']),
    st.sampled_from(['', 'robot_1/', 'phantomx_']),
)
def test_any_order_with_further_joints_finds_every_joint(names: list[str], prefix: str) -> None:
    named = [prefix + name for name in names]
    values = np.array([float(JOINTS.index(n)) if n in JOINTS else np.nan for n in names])
    order = joint_order(named)
    assert order is not None
    np.testing.assert_array_equal(values[order], np.arange(18.0))


@pytest.mark.parametrize('kind', [list, tuple])
def test_our_own_order_needs_no_index(kind: type) -> None:
    assert joint_order(kind(JOINTS)) is None


def test_plain_names_win_over_prefixed_ones() -> None:
    both = [f'copy_{joint}' for joint in JOINTS] + list(JOINTS)
    assert joint_prefix(both) == ''
    np.testing.assert_array_equal(joint_order(both), np.arange(18, 36))


@pytest.mark.parametrize(
    ('names', 'complaint'),
    [
        (JOINTS[:-1], 'name lacks rr_ankle, expected all 18 joints'),
        ((*JOINTS, 'lm_knee'), 'name has lm_knee twice'),
        ((), 'name lacks lf_hip, lf_knee'),
        (('a_lf_hip', *JOINTS[1:]), 'name lacks lf_hip, expected'),
    ],
)
def test_a_missing_or_doubled_joint_is_named(names: tuple[str, ...], complaint: str) -> None:
    with pytest.raises(ValueError, match=complaint):
        joint_order(names)


def test_numbers_come_in_our_order() -> None:
    names = [*JOINTS[::-1], 'gripper']
    np.testing.assert_array_equal(
        by_joint(names, range(19), 'position'), np.arange(17.0, -1.0, -1.0)
    )
    np.testing.assert_array_equal(by_joint(JOINTS, range(18), 'position'), np.arange(18.0))
    with pytest.raises(ValueError, match='position has 17 numbers for 18 names'):
        by_joint(JOINTS, range(17), 'position')
