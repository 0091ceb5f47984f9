# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The written-out gradients are those of autograd, and the critic's merge does what it says."""

import pytest
import torch
from hexapod_agent.algorithms.ddpg.networks import Actor, Critic, initial_bounds
from hexapod_agent.algorithms.ddpg.parameters import ParameterStack

OBSERVATION, ACTION, HIDDEN, BATCH = 7, 4, (12, 9), 6
STACKS = pytest.mark.parametrize('agents', [1, 3])
MERGES = pytest.mark.parametrize('merge', ['add', 'append'])


def draw(*shape: int, seed: int = 0) -> torch.Tensor:
    generator = torch.Generator().manual_seed(seed)
    return torch.rand(*shape, generator=generator, dtype=torch.float64) * 2 - 1


def parameter_stack(shapes, agents: int) -> ParameterStack:
    """Parameters large enough that every path through the network counts."""
    parameters = ParameterStack(shapes, agents, torch.float64)
    parameters.draw(dict.fromkeys(shapes, 0.8), torch.Generator().manual_seed(1))
    return parameters


def squeezed(tensor: torch.Tensor) -> torch.Tensor:
    """What the layers of a stack of one expect."""
    return tensor[0].clone() if tensor.shape[0] == 1 else tensor.clone()


def leaves(parameters: ParameterStack) -> dict[str, torch.Tensor]:
    return {name: a.clone().requires_grad_() for name, a in parameters.arrays.items()}


def reference_affine(arrays, name: str, x: torch.Tensor) -> torch.Tensor:
    weight, bias = arrays[f'{name}.weight'], arrays[f'{name}.bias']
    return torch.einsum('abi,aoi->abo', x, weight) + bias.unsqueeze(1)


def reference_actor(arrays, observation: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    x = reference_affine(arrays, 'hidden0', observation).relu()
    x = reference_affine(arrays, 'hidden1', x).relu()
    z = reference_affine(arrays, 'output', x)
    return z.tanh(), z


def reference_critic(arrays, observation, action, merge: str) -> torch.Tensor:
    x = reference_affine(arrays, 'observation0', observation).relu()
    x = reference_affine(arrays, 'observation1', x)
    y = reference_affine(arrays, 'action', action)
    merged = torch.cat([x, y], dim=-1) if merge == 'append' else x + y
    return reference_affine(arrays, 'output', merged.relu())


def check_gradients(gradients: ParameterStack, arrays, loss: torch.Tensor) -> None:
    loss.backward()
    for name, array in arrays.items():
        torch.testing.assert_close(gradients.arrays[name], array.grad, rtol=1e-10, atol=1e-12)


@STACKS
def test_actor_gradients_match_autograd(agents):
    parameters = parameter_stack(Actor.shapes(OBSERVATION, ACTION, HIDDEN), agents)
    gradients = parameters.like()
    actor = Actor(parameters, BATCH, gradients)
    observation = draw(agents, BATCH, OBSERVATION)
    action_gradient = draw(agents, BATCH, ACTION, seed=2)

    action = actor.forward(squeezed(observation))
    actor.backward(squeezed(action_gradient), 0.7)

    arrays = leaves(parameters)
    expected, z = reference_actor(arrays, observation)
    torch.testing.assert_close(action, squeezed(expected.detach()))
    check_gradients(gradients, arrays, (expected * action_gradient).sum() + 0.35 * (z * z).sum())


@STACKS
@MERGES
def test_critic_gradients_match_autograd(agents, merge):
    parameters = parameter_stack(Critic.shapes(OBSERVATION, ACTION, HIDDEN, merge), agents)
    gradients = parameters.like()
    critic = Critic(parameters, BATCH, gradients)
    observation = draw(agents, BATCH, OBSERVATION)
    action = draw(agents, BATCH, ACTION, seed=3)
    value_gradient = draw(agents, BATCH, 1, seed=4)

    value = critic.forward(squeezed(observation), squeezed(action))
    critic.backward(squeezed(value_gradient))
    slope = critic.action_gradient(squeezed(value_gradient))

    arrays = leaves(parameters)
    action.requires_grad_()
    expected = reference_critic(arrays, observation, action, merge)
    torch.testing.assert_close(value, squeezed(expected.detach()))
    check_gradients(gradients, arrays, (expected * value_gradient).sum())
    torch.testing.assert_close(slope, squeezed(action.grad), rtol=1e-10, atol=1e-12)


def value_differences(merge: str) -> torch.Tensor:
    """Q(s, a) - Q(s, a') of one pair of actions in many states."""
    shapes = Critic.shapes(OBSERVATION, ACTION, HIDDEN, merge)
    critic = Critic(parameter_stack(shapes, 1), 50)
    observation = draw(50, OBSERVATION)
    pair = draw(2, ACTION, seed=5)
    first = critic.forward(observation, pair[0].expand(50, -1)).clone()
    return first - critic.forward(observation, pair[1].expand(50, -1))


def test_appended_branches_separate():
    """Q = f(s) + g(a): which of two actions is better cannot depend on the state."""
    differences = value_differences('append')
    assert differences.abs().min() > 0.01
    torch.testing.assert_close(differences, differences[:1].expand_as(differences))


def test_added_branches_couple():
    differences = value_differences('add')
    assert differences.std() > 0.1 * differences.abs().mean()


def test_initial_bounds_are_those_of_the_source():
    bounds = initial_bounds(Critic.shapes(108, 30, (400, 300)))
    # 1/sqrt(108), 1/sqrt(400) and 1/sqrt(30): fan in of the layer.
    assert bounds['observation0.bias'] == pytest.approx(0.0962, abs=1e-4)
    assert bounds['observation1.weight'] == pytest.approx(0.05)
    assert bounds['action.weight'] == pytest.approx(0.1826, abs=1e-4)
    assert bounds['output.weight'] == bounds['output.bias'] == 5e-3


def test_stacked_agents_compute_what_each_computes_alone():
    shapes = Critic.shapes(OBSERVATION, ACTION, HIDDEN)
    stack = parameter_stack(shapes, 3)
    observation, action = draw(3, BATCH, OBSERVATION), draw(3, BATCH, ACTION, seed=1)
    together = Critic(stack, BATCH).forward(observation, action)
    for agent in range(3):
        alone = ParameterStack(shapes, 1, torch.float64)
        alone.flat.copy_(stack.flat[agent])
        value = Critic(alone, BATCH).forward(observation[agent], action[agent])
        torch.testing.assert_close(value, together[agent], rtol=1e-12, atol=1e-14)


@STACKS
def test_bfloat16_gradients_stay_near_those_of_float32(agents):
    """Rounding of the hidden layers alone: 8 bits leave errors of about a per cent."""
    shapes = Critic.shapes(OBSERVATION, ACTION, HIDDEN)
    parameters = ParameterStack(shapes, agents)
    parameters.draw(dict.fromkeys(shapes, 0.8), torch.Generator().manual_seed(1))
    observation = squeezed(draw(agents, BATCH, OBSERVATION).float())
    action = squeezed(draw(agents, BATCH, ACTION, seed=3).float())
    value_gradient = squeezed(draw(agents, BATCH, 1, seed=4).float())
    results = []
    for dtype in (torch.float32, torch.bfloat16):
        gradients = parameters.like()
        critic = Critic(parameters, BATCH, gradients, dtype)
        value = critic.forward(observation, action).clone()
        critic.backward(value_gradient)
        slope = critic.action_gradient(value_gradient).clone()
        results.append((value, gradients.flat, slope))
    for exact, rounded in zip(*results, strict=True):
        assert rounded.dtype == torch.float32
        assert 0 < (rounded - exact).norm() < 0.02 * exact.norm()


def test_shorter_format_follows_its_parameters_after_refresh():
    shapes = Actor.shapes(OBSERVATION, ACTION, HIDDEN)
    parameters = ParameterStack(shapes)
    actor = Actor(parameters, BATCH, dtype=torch.bfloat16)
    observation = draw(BATCH, OBSERVATION).float()
    assert not actor.forward(observation).any()
    parameters.draw(dict.fromkeys(shapes, 0.8), torch.Generator().manual_seed(1))
    actor.refresh()
    expected = Actor(parameters, BATCH).forward(observation)
    torch.testing.assert_close(actor.forward(observation), expected, atol=0.02, rtol=0)
