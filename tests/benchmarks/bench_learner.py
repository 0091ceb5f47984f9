# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Time of one update on one core, beside other learners' and its bare matrix products.

Run: `make bench-learner`, or `python tests/benchmarks/bench_learner.py` for ours alone. Sizes are
those of ABCDE: 108 observations, 30 actions, hidden layers of 400 and 300, batches of 128, updates
in groups as article.yaml has them. The others live in an environment of their own
(requirements-bench.txt) and are run one after another in this run: stable-baselines3 (PyTorch),
sbx (JAX, a group of updates in one compiled loop) and RLtools (C++). RLtools has neither DDPG nor
layers of unequal width: its TD3, with hidden layers of 350, stands beside its own bare products.
All are held to one core; times are processor time, the best of several rounds: other load only
ever adds. GFLOP/s counts the matrix products of the formulas alone.

The bare products are made by torch, which ours takes, and by numpy's BLAS; the title says which
instructions torch takes. A host with AVX2 alone is imitated by the environment variables
ATEN_CPU_CAPABILITY=avx2, ONEDNN_MAX_CPU_ISA=AVX2, MKL_ENABLE_INSTRUCTIONS=AVX2 and
OPENBLAS_CORETYPE=ZEN. XLA heeds none of these, nor a mask of its own (a product of cubes of 1024
ran at 210 GFLOP/s, more than AVX2 can do): sbx is comparable on a real one only.
"""

import argparse
import json
import os
import subprocess
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

os.environ['OPENBLAS_NUM_THREADS'] = '1'  # read when numpy is imported

import numpy as np
import stable_baselines3
import torch
from hexapod_agent.environment.env import HexapodLine
from hexapod_agent.learning.numerics import set_numerics
from hexapod_agent.learning.training import Trainer
from hexapod_agent.specification.run_spec import RunSpec
from hexapod_cpg.mapping import ACTION_SIZE
from rich.console import Console
from rich.table import Table

PEERS = Path(__file__).parent / 'peers'
WIDTH = 350
ROUNDS, REPEATS = 15, 50
BARE = 'bare products, float32_fast'
Product = Callable[..., object]


def milliseconds(call: Callable[[], object], repeats: int = REPEATS) -> float:
    """Best mean time of a call over the rounds."""
    best = float('inf')
    for _ in range(ROUNDS):
        start = time.process_time()
        for _ in range(repeats):
            call()
        best = min(best, (time.process_time() - start) / repeats)
    return best * 1e3


Shapes = list[tuple[int, int, int]]


def update_products(batch: int, sizes: Sequence[int], critics: int = 1) -> Shapes:
    """Rows, inner size and columns of every product that the formulas of one update need.

    Forward: target actor, target critics, critics, actor, one critic again. Back: all weights of
    the critics, one critic's action branch, all weights of the actor.
    """
    observation, first, second, action = sizes
    actor = [(batch, observation, first), (batch, first, second), (batch, second, action)]
    critic = [*actor[:2], (batch, action, second), (batch, second, 1)]
    hidden_back = [(second, batch, first), (batch, second, first), (first, batch, observation)]
    action_back = [(batch, 1, second), (batch, second, action)]
    critic_back = [(1, batch, second), (batch, 1, second), (second, batch, action), *hidden_back]
    actor_back = [(action, batch, second), (batch, action, second), *hidden_back]
    return [
        *actor, *(critic * 2 + critic_back) * critics, *actor, *critic, *action_back, *actor_back,
    ]  # fmt: skip


def multiply(shapes: Shapes, product: Product = torch.mm) -> Callable[[], None]:
    """Return a call of these products by a library, and of nothing else."""
    operands = [
        (torch.randn(rows, inner), torch.randn(inner, columns), torch.empty(rows, columns))
        for rows, inner, columns in shapes
    ]

    def run() -> None:
        for left, right, out in operands:
            product(left, right, out=out)

    return run


def numpys_product(left: torch.Tensor, right: torch.Tensor, *, out: torch.Tensor) -> None:
    """Let numpy's BLAS multiply."""
    np.matmul(left.numpy(), right.numpy(), out=out.numpy())


def gflop(shapes: Shapes) -> float:
    """Return the multiplications and additions of these products, in 1e9."""
    return sum(2e-9 * rows * inner * columns for rows, inner, columns in shapes)


def full_trainer(changes: dict[str, Any]) -> tuple[Trainer, HexapodLine]:
    """A trainer of ABCDE with a group of updates due, and its environment."""
    config = RunSpec.from_mapping(changes, 'benchmark').observing('ABCDE')
    set_numerics(config.training.precision)
    trainer, env = Trainer(config, 1), HexapodLine('ABCDE', config)
    observation, _ = env.reset(seed=1)
    trainer.begin_episode(0)
    for _ in range(config.task.time_limit_steps):
        observation, *_ = env.step(trainer.observe(observation, env.outcome))
    return trainer, env


def time_ours(changes: dict[str, Any]) -> float:
    """One update of ours, in ms."""
    trainer, _ = full_trainer(changes)
    trainer.learn()
    return milliseconds(trainer.learn, 3) / trainer.learner.due


def time_peer(python: Path, script: str, sizes: dict[str, Any]) -> float | str:
    """One update of another learner, in ms; or the last line of what it said instead."""
    one_thread = {
        'OMP_NUM_THREADS': '1',
        'MKL_NUM_THREADS': '1',
        'XLA_FLAGS': '--xla_cpu_multi_thread_eigen=false',
    }
    done = subprocess.run(
        [python, PEERS / script, json.dumps(sizes)],
        capture_output=True, text=True, check=False, env=os.environ | one_thread,
    )  # fmt: skip
    lines = (done.stdout if done.returncode == 0 else done.stderr).strip().splitlines()
    return float(lines[-1]) if done.returncode == 0 else (lines or ['ended without a word'])[-1]


def time_baseline(trainer: Trainer, env: HexapodLine) -> float:
    """One gradient step of stable-baselines3's DDPG with the same layers and batch."""
    config, group = trainer.config, trainer.learner.due
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
    """Print the tables."""
    parser = argparse.ArgumentParser(description='time of one update of several learners')
    parser.add_argument('--peers', type=Path, metavar='PYTHON', help='of their environment')
    peers = parser.parse_args().peers
    os.sched_setaffinity(0, [min(os.sched_getaffinity(0))])
    precisions = {
        f'ours, {name}': {'training': {'precision': name}}
        for name in ('float32', 'float32_fast', 'bfloat16')
    }
    ours: dict[str, float | str] = {name: time_ours(each) for name, each in precisions.items()}
    trainer, env = full_trainer(precisions['ours, float32_fast'])
    learner = trainer.config.learner
    layers = {'actor': list(learner.actor.hidden), 'critic': list(learner.critic.hidden)}
    sizes = (trainer.spec.size, *learner.actor.hidden, ACTION_SIZE)
    shapes = update_products(learner.ddpg.batch_size, sizes)
    references: dict[str, float | str] = {}
    asked = {
        'observation': trainer.spec.size, 'action': ACTION_SIZE, 'batch': learner.ddpg.batch_size,
        'group': learner.ddpg.group_size, 'rounds': ROUNDS, 'width': WIDTH, **layers,
    }  # fmt: skip
    if peers:
        references['sbx, DDPG'] = time_peer(peers, 'sbx_ddpg.py', asked)
    references[f'stable-baselines3 {stable_baselines3.__version__}, DDPG'] = time_baseline(
        trainer, env
    )
    references[BARE] = milliseconds(multiply(shapes))
    references['bare products, numpy'] = milliseconds(multiply(shapes, numpys_product))
    torch.set_float32_matmul_precision('highest')
    references["bare products, torch's default"] = milliseconds(multiply(shapes))
    capability = torch.backends.cpu.get_cpu_capability()
    title = f'DDPG, hidden layers of 400 and 300; torch takes {capability}'
    show(title, ours, references, gflop(shapes))
    if peers:
        shapes = update_products(learner.ddpg.batch_size, (sizes[0], WIDTH, WIDTH, ACTION_SIZE), 2)
        torch.set_float32_matmul_precision('medium')
        products = milliseconds(multiply(shapes))
        others = {'RLtools, TD3': time_peer(peers, 'rltools_td3.py', asked)}
        show(
            f'two critics, hidden layers of {WIDTH}', {}, others | {BARE: products}, gflop(shapes)
        )


def show(
    title: str, ours: dict[str, float | str], others: dict[str, float | str], work: float
) -> None:
    """Print times, what they make of the work, and how many times as long as others they take."""
    bases = {name.split(', ')[1]: float(each) for name, each in ours.items()}
    bases['bare products'] = float(others[BARE])
    table = Table(title, 'ms', 'GFLOP/s', *(f'x {name}' for name in bases))
    for name, time_ms in (ours | others).items():
        if isinstance(time_ms, str):
            table.add_row(name, time_ms)
            continue
        ratios = (f'{time_ms / base:.2f}' for base in bases.values())
        table.add_row(name, f'{time_ms:.2f}', f'{work / time_ms * 1e3:.0f}', *ratios)
    Console().print(table)


if __name__ == '__main__':
    main()
