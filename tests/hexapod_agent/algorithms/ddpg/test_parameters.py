# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Layout, initial distribution and independence of a stack's parameters."""

import torch
from hexapod_agent.algorithms.ddpg.parameters import ParameterStack

SHAPES = {'a.weight': (3, 5), 'a.bias': (3,), 'b.weight': (2, 3)}


def test_arrays_are_views_of_the_flat_tensor():
    stack = ParameterStack(SHAPES, agents=2)
    for number, array in enumerate(stack.arrays.values(), start=1):
        array.fill_(number)
    assert {name: tuple(a.shape) for name, a in stack.arrays.items()} == {
        'a.weight': (2, 3, 5), 'a.bias': (2, 3), 'b.weight': (2, 2, 3),
    }  # fmt: skip
    # 15 + 3 + 6 numbers per agent, padded to three blocks of 16.
    assert stack.flat.shape == (2, 48)
    assert stack.flat.sum() == 2 * (15 * 1 + 3 * 2 + 6 * 3)


def test_draw_fills_each_array_within_its_bound_and_leaves_the_padding():
    stack = ParameterStack(SHAPES, agents=50)
    bounds = {'a.weight': 0.5, 'a.bias': 0.1, 'b.weight': 2.0}
    stack.draw(bounds, torch.Generator().manual_seed(0))
    for name, array in stack.arrays.items():
        assert 0.9 * bounds[name] < array.abs().max() <= bounds[name]
    assert stack.flat[:, 15].eq(0).all()


def test_agents_of_a_stack_start_apart():
    stack = ParameterStack(SHAPES, agents=2)
    stack.draw(dict.fromkeys(SHAPES, 1.0), torch.Generator().manual_seed(0))
    assert not torch.equal(stack.flat[0], stack.flat[1])


def test_views_for_layers_lose_the_agents_of_a_stack_of_one():
    assert ParameterStack(SHAPES, 1).weight('a.weight').shape == (3, 5)
    assert ParameterStack(SHAPES, 1).bias('a.bias').shape == (3,)
    assert ParameterStack(SHAPES, 2).weight('a.weight').shape == (2, 3, 5)
    assert ParameterStack(SHAPES, 2).bias('a.bias').shape == (2, 1, 3)


def test_an_agent_that_is_put_in_is_padded_with_zeros_and_taken_out_whole():
    stack = ParameterStack(SHAPES, agents=2)
    stack.flat.fill_(9.0)
    single = ParameterStack(SHAPES | {'a.weight': (3, 4)})  # one input less
    single.draw(dict.fromkeys(SHAPES, 1.0), torch.Generator().manual_seed(0))
    stack.put(1, single)
    assert torch.equal(stack.arrays['a.weight'][1, :, :4], single.arrays['a.weight'][0])
    assert not stack.arrays['a.weight'][1, :, 4].any()
    assert stack.flat[0].eq(9.0).all()
    taken = single.like()
    stack.take(1, taken)
    assert torch.equal(taken.flat, single.flat)
