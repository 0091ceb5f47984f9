# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Clipping works on each array of each agent; Adam's first steps are those of its formula."""

import pytest
import torch
from hexapod_agent.algorithms.ddpg.optimizer import ClippedAdam
from hexapod_agent.algorithms.ddpg.parameters import ParameterStack


def test_each_array_is_clipped_to_the_threshold_alone():
    parameters = ParameterStack({'a.weight': (2, 2), 'b.bias': (3,)}, agents=2)
    optimizer = ClippedAdam(parameters, 1e-3, l2=0.0, threshold=1.0)
    gradients = optimizer.gradients.arrays
    gradients['a.weight'][0] = torch.tensor([[3.0, 0.0], [0.0, 4.0]])  # norm 5
    gradients['a.weight'][1] = torch.tensor([[0.3, 0.0], [0.0, 0.4]])  # norm 0.5, stays
    gradients['b.bias'][0] = torch.tensor([0.0, 2.0, 0.0])
    optimizer.step()
    torch.testing.assert_close(gradients['a.weight'][0], torch.tensor([[0.6, 0], [0, 0.8]]))
    torch.testing.assert_close(gradients['a.weight'][1], torch.tensor([[0.3, 0], [0, 0.4]]))
    torch.testing.assert_close(gradients['b.bias'][0], torch.tensor([0.0, 1.0, 0.0]))


def test_l2_term_is_added_to_weights_before_their_norm_is_taken():
    parameters = ParameterStack({'a.weight': (1, 2), 'a.bias': (2,)})
    optimizer = ClippedAdam(parameters, 1e-3, l2=0.5, threshold=1.0)
    parameters.arrays['a.weight'].copy_(torch.tensor([[[6.0, 8.0]]]))
    parameters.arrays['a.bias'].fill_(9.0)
    optimizer.step()
    # Without the term 0. With it 0.5 (6, 8) = (3, 4), of length 5, is clipped to (0.6, 0.8).
    gradients = optimizer.gradients.arrays
    torch.testing.assert_close(gradients['a.weight'], torch.tensor([[[0.6, 0.8]]]))
    assert not gradients['a.bias'].any()


def test_two_steps_follow_the_formula():
    parameters = ParameterStack({'a.bias': (1,)}, dtype=torch.float64)
    optimizer = ClippedAdam(parameters, 0.1, l2=0.0, threshold=10.0)
    optimizer.gradients.arrays['a.bias'].fill_(2.0)
    optimizer.step()
    # m = 0.1 g, v = 0.001 g², corrected to g and g²: the step is -0.1 g / |g|.
    assert parameters.arrays['a.bias'].item() == pytest.approx(-0.1, rel=1e-7)
    optimizer.gradients.arrays['a.bias'].fill_(-1.0)
    optimizer.step()
    # m = 0.9 0.2 - 0.1 = 0.08, over 1 - 0.9² = 0.19; v = 0.999 0.004 + 0.001 = 0.004996, over
    # 1 - 0.999² = 0.001999: the step is -0.1 0.421053 / sqrt(2.499250) = -0.0266337.
    assert parameters.arrays['a.bias'].item() == pytest.approx(-0.1266337, abs=1e-7)


def test_state_carries_moments_and_step_count():
    def run(steps: int, optimizer: ClippedAdam) -> None:
        for step in range(steps):
            optimizer.gradients.flat.fill_(0.1 * step - 0.3)
            optimizer.step()

    parameters = ParameterStack({'a.bias': (4,)})
    optimizer = ClippedAdam(parameters, 0.1, 0.0, 1.0)
    run(5, optimizer)
    twin_parameters = ParameterStack({'a.bias': (4,)})
    twin_parameters.flat.copy_(parameters.flat)
    twin = ClippedAdam(twin_parameters, 0.1, 0.0, 1.0)
    twin.load_state_dict(optimizer.state_dict())
    run(5, optimizer)
    run(5, twin)
    assert torch.equal(parameters.flat, twin_parameters.flat)


def test_agents_at_different_steps_move_as_they_do_alone():
    shapes = {'a.weight': (2, 3), 'a.bias': (2,)}

    def gradient(step: int) -> float:
        return 0.1 * step - 0.25

    alone = ParameterStack(shapes)
    optimizer = ClippedAdam(alone, 0.1, 0.1, 1.0)
    both = ParameterStack(shapes, agents=2)
    stack = ClippedAdam(both, 0.1, 0.1, 1.0)
    # The second agent begins when the first has taken three steps.
    stack.move_only([0])
    for step in range(3):
        stack.gradients.flat.fill_(gradient(step))
        stack.step()
    assert not both.flat[1].any()
    stack.move_only([0, 1])
    for step in range(4):
        optimizer.gradients.flat.fill_(gradient(step))
        optimizer.step()
        stack.gradients.flat[0].fill_(gradient(step + 3))
        stack.gradients.flat[1].fill_(gradient(step))
        stack.step()
    torch.testing.assert_close(both.flat[1:], alone.flat)
    assert stack.state_dict()['steps'].tolist() == [7, 4]


def test_each_agent_steps_by_its_share_of_the_learning_rate():
    parameters = ParameterStack({'a.bias': (1,)}, agents=3, dtype=torch.float64)
    optimizer = ClippedAdam(parameters, 0.1, l2=0.0, threshold=10.0)
    for agent, share in enumerate((1.0, 0.5, 0.25)):
        optimizer.set_share(agent, share)
    optimizer.move_only([0, 2])
    optimizer.gradients.flat.fill_(2.0)
    optimizer.step()
    # Adam's first step is the rate itself.
    torch.testing.assert_close(
        parameters.arrays['a.bias'][:, 0], torch.tensor([-0.1, 0.0, -0.025]).double(), rtol=1e-7,
        atol=0.0,
    )  # fmt: skip


def test_state_moves_between_a_stack_and_a_single_agent():
    shapes = {'a.bias': (4,)}
    single = ClippedAdam(ParameterStack(shapes), 0.1, 0.0, 1.0)
    single.gradients.arrays['a.bias'].fill_(0.3)
    single.step()
    stack = ClippedAdam(ParameterStack(shapes, agents=3), 0.1, 0.0, 1.0)
    stack.put(2, single)
    assert stack.state_dict()['steps'].tolist() == [0, 0, 1]
    copy = ClippedAdam(ParameterStack(shapes), 0.1, 0.0, 1.0)
    stack.take(2, copy)
    for name, value in single.state_dict().items():
        assert torch.equal(copy.state_dict()[name], value)
