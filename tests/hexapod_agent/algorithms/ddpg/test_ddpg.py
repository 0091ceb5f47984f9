# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Updates are those of the reference by autograd; the switches do what they name."""

import numpy as np
import pytest
import torch
from hexapod_agent.algorithms.ddpg.ddpg import Ddpg
from hexapod_agent.algorithms.ddpg.parameters import ParameterStack
from hexapod_agent.algorithms.replay import Batch
from hexapod_agent.specification.run_spec import RunSpec
from reference_ddpg import ReferenceDdpg

SIZES = (5, 3)
BATCH = 16


def config_of(batch: int = BATCH, rate: float = 1e-2, critic: dict | None = None, **actor):
    """The learner's section with every switch off, but for those given."""
    common = {'hidden': [20, 10], 'learning_rate': rate, 'l2': 0.0, 'gradient_threshold': 1e6}
    off = {'preactivation_penalty': 0.0, 'normalize_loss': False}
    sections = {
        'actor': common | off | actor,
        'critic': common | {'initial_value': 0.0} | (critic or {}),
        'ddpg': {'batch_size': batch, 'target_smoothing': 0.1},
    }
    return RunSpec.from_mapping({'learner': sections}, 'a test').learner


def make(agents: int = 1, seed: int = 0, observations: int = SIZES[0], **changes) -> Ddpg:
    generator = torch.Generator().manual_seed(seed)
    return Ddpg(
        observations, SIZES[1], config_of(**changes), generator, agents, dtype=torch.float64
    )


def empty(agents: int = 1, batch: int = BATCH, observations: int = SIZES[0]) -> Batch:
    return Batch.empty(agents, batch, observations, SIZES[1], torch.float64)


def fill(agent: Ddpg, agents: int = 1, seed: int = 0) -> Batch:
    """Draw the agents' output layers, and return transitions for each of them."""
    generator = torch.Generator().manual_seed(seed)
    batch = empty(agents)
    for tensor in vars(batch).values():
        tensor.uniform_(-1, 1, generator=generator)
    # Larger weights than the initial ones, so that no term of the update is negligible.
    for parameters in (agent.actor_parameters, agent.critic_parameters):
        for name, array in parameters.arrays.items():
            if name.startswith('output'):
                array.uniform_(-0.5, 0.5, generator=generator)
    return batch


def arrays_of(agent: Ddpg, target: bool) -> dict[str, dict[str, torch.Tensor]]:
    """Arrays of a stack of one by network, of the targets or of what they follow."""
    layouts = {'actor': agent.actor_parameters, 'critic': agent.critic_parameters}
    state, prefix = agent.state_dict(), 'target_' if target else ''
    return {
        name: {key: each[0] for key, each in with_numbers(layout, state[prefix + name]).items()}
        for name, layout in layouts.items()
    }


SWITCHES = {
    'none': ({}, {}),
    'loss': ({'preactivation_penalty': 0.02, 'normalize_loss': True}, {}),
    'append': ({'l2': 1e-2}, {'merge': 'append'}),
    'clip': ({'gradient_threshold': 1e-2}, {'gradient_threshold': 0.1, 'l2': 1e-2}),
    'deep': ({'hidden': (20, 12, 10)}, {'hidden': (16,), 'initial_value': 2.0}),
}


@pytest.mark.parametrize('switches', SWITCHES)
def test_updates_are_those_of_the_reference(switches):
    actor, critic = SWITCHES[switches]
    agent = make(critic=critic, **actor)
    batch = fill(agent).inner(0)
    config = config_of(critic=critic, **actor)
    reference = ReferenceDdpg(config, *(arrays_of(agent, target) for target in (False, True)))
    for _ in range(3):
        seen = [each.item() for each in agent.update(batch)]
        assert seen == pytest.approx(reference.update(batch), rel=1e-7)
    for target, expected in ((False, reference.networks), (True, reference.targets)):
        found = arrays_of(agent, target)
        assert found.keys() == expected.keys()
        for name, arrays in expected.items():
            for key, array in arrays.items():
                torch.testing.assert_close(found[name][key], array.detach(), rtol=1e-7, atol=1e-10)


def test_agents_of_a_stack_do_not_touch_one_another():
    """The first agent learns the same whatever the second one sees."""
    stacks = []
    for seed in (1, 2):
        agent = make(agents=2)
        batch = fill(agent, agents=2)
        for tensor in vars(batch).values():
            tensor[1].uniform_(-1, 1, generator=torch.Generator().manual_seed(seed))
        for _ in range(3):
            agent.update(batch)
        stacks.append(agent)
    first, second = stacks
    assert torch.equal(first.actor_parameters.flat[0], second.actor_parameters.flat[0])
    assert not torch.equal(first.actor_parameters.flat[1], second.actor_parameters.flat[1])


def test_a_stack_learns_what_single_agents_learn():
    stack, single = make(agents=2), make()
    batch = fill(stack, agents=2)
    for name, part in single.state_dict().items():
        if not name.endswith('optimizer'):
            part.copy_(stack.state_dict()[name][:1])
    for _ in range(3):
        stack.update(batch)
        single.update(batch.inner(0))
    torch.testing.assert_close(stack.actor_parameters.flat[:1], single.actor_parameters.flat)


def test_only_the_agents_that_learn_are_moved():
    stack = make(agents=3)
    batch = fill(stack, agents=3)
    before = {name: part.clone() for name, part in stacks_of(stack).items()}
    stack.learn_only([0, 2])
    stack.update(batch)
    for name, part in stacks_of(stack).items():
        moved = [not torch.equal(part[agent], before[name][agent]) for agent in range(3)]
        assert moved == [True, False, True], name


def test_an_agent_put_in_a_wider_stack_learns_as_alone():
    single, stack = make(), make(agents=2, observations=SIZES[0] + 4)
    narrow, wide = fill(single), empty(agents=2, observations=SIZES[0] + 4)
    stack.put(1, single)
    for ours, theirs in zip(vars(wide).values(), vars(narrow).values(), strict=True):
        ours[1, :, : theirs.shape[-1]] = theirs[0]
    for _ in range(3):
        stack.update(wide)
        single.update(narrow.inner(0))
    taken = make(seed=1)
    stack.take(1, taken)
    for name, part in stacks_of(single).items():
        torch.testing.assert_close(stacks_of(taken)[name], part)


def stacks_of(agent: Ddpg) -> dict[str, torch.Tensor]:
    """Networks and targets of a state."""
    return {name: part for name, part in agent.state_dict().items() if 'optimizer' not in name}


def with_numbers(like: ParameterStack, flat: torch.Tensor) -> dict[str, torch.Tensor]:
    """Arrays of a state's flat tensor."""
    stack = like.like()
    stack.flat.copy_(flat)
    return stack.arrays


def test_preactivation_penalty_keeps_actions_off_the_bounds():
    """A critic that always wants more drives an unpenalised actor to the bound."""
    outputs = {}
    for penalty in (0.0, 0.3):
        agent = make(preactivation_penalty=penalty)
        batch = fill(agent).inner(0)
        batch.bootstrap.zero_()
        generator = torch.Generator().manual_seed(1)
        for _ in range(1500):
            batch.action.uniform_(-1, 1, generator=generator)
            batch.reward.copy_(batch.action.sum(dim=-1, keepdim=True))
            agent.update(batch)
        outputs[penalty] = agent.act(batch.observation[:1]).abs().mean().item()
    assert outputs[0.0] > 0.99
    assert outputs[0.3] < 0.95


def test_learns_the_best_action_of_each_state():
    """One-step problem: reward -|a - s|², so the best action is the state's first numbers."""
    agent = make(batch=64, rate=2e-3)
    generator = torch.Generator().manual_seed(0)
    batch = empty(batch=64).inner(0)
    for _ in range(3000):
        batch.observation.uniform_(-0.8, 0.8, generator=generator)
        batch.action.uniform_(-1, 1, generator=generator)
        error = batch.action - batch.observation[..., :3]
        batch.reward.copy_(-(error * error).sum(dim=-1, keepdim=True))
        agent.update(batch)
    error = torch.cat(
        [agent.act(observation[None]) - observation[:3] for observation in batch.observation]
    )
    # A constant action would miss by 0.46, the standard deviation of U(-0.8, 0.8).
    assert error.square().mean().sqrt() < 0.15


def test_same_seed_same_weights():
    first, second, other = make(seed=3), make(seed=3), make(seed=4)
    assert torch.equal(first.actor_parameters.flat, second.actor_parameters.flat)
    assert torch.equal(first.critic_parameters.flat, second.critic_parameters.flat)
    assert not torch.equal(first.actor_parameters.flat, other.actor_parameters.flat)


def test_initial_value_is_that_of_every_state_and_of_the_target():
    agent = make(critic={'initial_value': 50.0})
    for part in ('critic', 'target_critic'):
        stack = agent.critic_parameters.like()
        stack.flat.copy_(agent.state_dict()[part])
        assert stack.arrays['output.bias'].item() == pytest.approx(50.0, abs=5e-3)
    batch = empty().inner(0)
    batch.bootstrap.fill_(0.5)
    # TD error Q - (r + Q'/2) = 25 but for what the small output weights add.
    assert agent.update(batch)[0].item() == pytest.approx(625.0, rel=0.01)


@pytest.mark.parametrize('fails', [False, True])
def test_denormal_numbers_survive_outside_an_update(fails, monkeypatch):
    """Flushing is a state of the thread, in which the physics may run as well."""
    agent = make()
    if fails:
        monkeypatch.setattr(agent, '_update_critic', lambda _batch: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            agent.update(empty().inner(0))
    else:
        agent.update(empty().inner(0))
    assert torch.tensor(1e-310, dtype=torch.float64) * 0.5 > 0


def test_the_policy_in_numpy_is_the_actor(make_trainer):
    trainer = make_trainer()
    networks = trainer.learner.networks
    networks.actor_parameters.flat.mul_(8.0)
    observation = np.linspace(-1.0, 1.0, trainer.spec.size, dtype=np.float32)
    action = torch.from_numpy(trainer.learner.act(observation, explore=False))
    torch.testing.assert_close(networks.act(torch.from_numpy(observation)[None])[0], action)
