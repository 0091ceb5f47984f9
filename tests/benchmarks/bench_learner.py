# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Time of one update on one core, against its bare matrix products and against stable-baselines3.

Run: `python tests/benchmarks/bench_learner.py`. Sizes are those of ABCDE: 108 observations, 30
actions, hidden layers of 400 and 300, batches of 128, updates in groups as article.yaml has them.
stable-baselines3 is timed where it can be imported, in groups of the same size. Times are
processor time, the best of several rounds: other load only ever adds.
"""

import time
from collections.abc import Callable

import numpy as np
import torch
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_cpg.mapping import ACTION_SIZE
from rich.console import Console
from rich.table import Table

try:
    import stable_baselines3
except ImportError:
    stable_baselines3 = None

ROUNDS, REPEATS = 15, 50


def milliseconds(call: Callable[[], object], repeats: int = REPEATS) -> float:
    """Best mean time of a call over the rounds."""
    best = float('inf')
    for _ in range(ROUNDS):
        start = time.process_time()
        for _ in range(repeats):
            call()
        best = min(best, (time.process_time() - start) / repeats)
    return best * 1e3


def matrix_products(batch: int, sizes: tuple[int, int, int, int]) -> Callable[[], None]:
    """Every product that the formulas of one update need, and nothing else.

    Forward: target actor, target critic, critic, actor, critic again. Back: all weights of the
    critic, the critic's action branch, all weights of the actor.
    """
    observation, first, second, action = sizes
    x, h1, h2 = (torch.randn(batch, n) for n in (observation, first, second))
    a, q = torch.randn(batch, action), torch.randn(batch, 1)
    w1, w2 = torch.randn(first, observation), torch.randn(second, first)
    wa, w3, wq = torch.randn(second, action), torch.randn(action, second), torch.randn(1, second)
    actor = [(x, w1.T), (h1, w2.T), (h2, w3.T)]
    critic = [(x, w1.T), (h1, w2.T), (a, wa.T), (h2, wq.T)]
    critic_back = [(q.T, h2), (q, wq), (h2.T, a), (h2.T, h1), (h2, w2), (h1.T, x)]
    action_back = [(q, wq), (h2, wa)]
    actor_back = [(a.T, h2), (a, w3), (h2.T, h1), (h2, w2), (h1.T, x)]
    products = [*actor, *critic, *critic, *critic_back, *actor, *critic, *action_back, *actor_back]
    pairs = [(left, right, torch.empty(left.shape[0], right.shape[1])) for left, right in products]

    def multiply() -> None:
        for left, right, out in pairs:
            torch.mm(left, right, out=out)

    return multiply


def full_trainer(precision: str, letters: str = 'ABCDE') -> tuple[Trainer, HexapodLine]:
    """A trainer with a group of updates due, and its environment."""
    config = RunSpec.from_mapping({'training': {'precision': precision}}, 'benchmark')
    trainer, env = Trainer(config.observing(letters), 1), HexapodLine(letters, config)
    observation, _ = env.reset(seed=1)
    trainer.begin_episode(0)
    for _ in range(config.task.time_limit_steps):
        observation, *_ = env.step(trainer.observe(observation, env.outcome))
    return trainer, env


def time_baseline(trainer: Trainer, env: HexapodLine) -> float:
    """One gradient step of stable-baselines3's DDPG with the same layers and batch."""
    config, group = trainer.config, trainer.due
    learner = config.learner
    layers = {'pi': list(learner.actor.hidden), 'qf': list(learner.critic.hidden)}
    model = stable_baselines3.DDPG(
        'MlpPolicy', env, batch_size=learner.ddpg.batch_size, buffer_size=2000, device='cpu',
        policy_kwargs={'net_arch': layers}, learning_starts=100, seed=1,
    )  # fmt: skip
    model.learn(600)
    batch = config.learner.ddpg.batch_size
    return milliseconds(lambda: model.train(gradient_steps=group, batch_size=batch), 3) / group


def main() -> None:
    """Print the table."""
    updates = {}
    for precision in ('float32', 'float32_fast', 'bfloat16'):
        trainer, env = full_trainer(precision)
        trainer.learn()
        updates[precision] = milliseconds(trainer.learn, 3) / trainer.due
    config = trainer.config
    sizes = (trainer.spec.size, *config.learner.actor.hidden, ACTION_SIZE)
    multiply = matrix_products(config.learner.ddpg.batch_size, sizes)
    references = {'its matrix products alone, float32_fast': milliseconds(multiply)}
    torch.set_float32_matmul_precision('highest')
    references["the same by torch's default, float32"] = milliseconds(multiply)
    if stable_baselines3:
        name = f'update of stable-baselines3 {stable_baselines3.__version__}'
        references[name] = time_baseline(trainer, env)
    action = np.zeros(ACTION_SIZE, np.float32)
    env.reset(seed=1)
    references['step of the environment'] = milliseconds(lambda: env.step(action), 40)

    table = Table('one core, ms', 'time', *(f'{name} / this' for name in updates))
    for name, time_ms in (updates | references).items():
        ratios = (f'{update / time_ms:.2f}' for update in updates.values())
        table.add_row(name, f'{time_ms:.2f}', *ratios)
    Console().print(table)


if __name__ == '__main__':
    main()
