# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Scenes: the same ground everywhere, as high as its geoms, and feet that stand on it."""

import math
from dataclasses import fields
from typing import get_type_hints

import mujoco
import numpy as np
import pytest
from hexapod_node.parameters import config_table
from hexapod_sim.scenes.rough import HALF_WIDTH
from hexapod_sim.scenes.scene import LENGTH
from hexapod_sim.scenes.table import SCENES, SceneConfig, check_walk
from hexapod_sim.sensors import read
from hexapod_sim.simulation import Simulation
from hexapod_sim.task import LineTask
from hexapod_sim.task_config import TaskConfig
from hexapod_sim.variations.table import RobotConfig
from hexapod_sim.world import World

from hexapod_sim import robot

NEUTRAL = np.tile(robot.NEUTRAL_POSE, (robot.SUBSTEPS, 1))
# Greatest depth of a contact of the standing robot on the flat floor, measured [m].
FLAT_DEPTH = 2.0e-4


def world(**changes) -> World:
    return World(SceneConfig.of_article(**changes), RobotConfig.of_article())


@pytest.fixture(scope='module', params=SCENES)
def simulation(request) -> Simulation:
    return Simulation(world(name=request.param))


def ground_by_ray(simulation: Simulation, x: float, y: float) -> float:
    """Return the height of the first geom that a ray from above meets, the robot's own apart."""
    origin, down = np.array([x, y, 5.0]), np.array([0.0, 0.0, -1.0])
    found = np.zeros(1, np.int32)
    base = simulation.model.body('base_link').id
    ray = mujoco.mj_ray(simulation.model, simulation.data, origin, down, None, 1, base, found)
    return 5.0 - ray


def test_the_table_is_what_a_key_may_name() -> None:
    assert get_type_hints(SceneConfig)['name'].__args__ == tuple(SCENES)


def test_each_option_has_its_range_and_unit() -> None:
    table = {entry.name: entry for entry in config_table(SceneConfig.of_article(), 'scene')}
    assert set(table) == {f'scene.{field.name}' for field in fields(SceneConfig)}
    assert all(entry.range or entry.choices for entry in table.values())
    assert all(entry.description for entry in table.values())
    assert {entry.name for entry in table.values() if not entry.unit} == {
        'scene.name',
        'scene.seed',
    }


def test_height_is_that_of_the_geoms(simulation: Simulation) -> None:
    rng = np.random.default_rng(3)
    x, y = rng.uniform(0.4, LENGTH + 1.0, 200), rng.uniform(-2.5, 2.5, 200)
    heights = simulation.world.scene.make().height(x, y)
    found = [ground_by_ray(simulation, *place) for place in zip(x, y, strict=True)]
    np.testing.assert_allclose(heights, found, atol=1e-9)
    assert [simulation.ground(*place) for place in zip(x, y, strict=True)] == heights.tolist()


def test_height_takes_what_broadcasts(simulation: Simulation) -> None:
    scene = simulation.world.scene.make()
    x, y = np.linspace(-1.0, 9.0, 7)[:, None], np.linspace(-3.0, 3.0, 5)
    assert scene.height(x, y).shape == (7, 5)
    assert scene.height(0.1, 0.2).shape == ()


def test_every_episode_starts_on_the_floor(simulation: Simulation) -> None:
    scene = simulation.world.scene.make()
    assert not scene.height(np.linspace(-1.0, 0.499, 50), np.linspace(-2.0, 2.0, 50)).any()
    np.testing.assert_array_equal(simulation.data.qpos, Simulation().data.qpos)


@pytest.mark.parametrize('name', SCENES)
def test_equal_options_make_an_equal_ground(name: str) -> None:
    ours, theirs = world(name=name).build()[0], world(name=name).build()[0]
    np.testing.assert_array_equal(ours.geom_pos, theirs.geom_pos)
    np.testing.assert_array_equal(ours.geom_size, theirs.geom_size)


def test_another_seed_makes_other_rough_ground_of_the_same_kind() -> None:
    x, y = np.meshgrid(np.linspace(0.6, 7.9, 60), np.linspace(-2.3, 2.3, 40))
    one, other = (
        SceneConfig.of_article(name='rough', roughness=0.05, seed=seed).make().height(x, y)
        for seed in (1, 2)
    )
    assert np.mean(one != other) > 0.99
    for heights in (one, other):
        assert 0.0 <= heights.min() < 0.002
        assert 0.048 < heights.max() <= 0.05
        assert heights.mean() == pytest.approx(0.025, abs=0.002)  # uniform


@pytest.mark.parametrize('changes', [{'name': 'rough', 'roughness': 0.0},
                                     {'name': 'stairs', 'rise': 0.0},
                                     {'name': 'slope', 'gradient': 0.0}])  # fmt: skip
def test_a_ground_without_height_is_the_floor(changes) -> None:
    assert world(**changes).build()[0].ngeom == Simulation().model.ngeom


@pytest.mark.parametrize(
    ('name', 'x'), [('flat', 2.0), ('rough', 2.0), ('stairs', 1.98), ('slope', 2.0)]
)
def test_feet_do_not_sink(name: str, x: float) -> None:
    """Each contact is as deep as on the floor, and the feet carry the weight."""
    simulation = Simulation(world(name=name))
    simulation.reset(0.0)
    simulation.data.qpos[0] = x
    simulation.data.qpos[2] += float(simulation.world.scene.make().height(x + 0.25, 0.0)) + 0.02
    for _ in range(160):
        simulation.advance(NEUTRAL)
    readings = read(simulation, ('foot_contacts', 'foot_wrench', 'height'))
    assert simulation.data.contact.dist.min() > -5 * FLAT_DEPTH
    # A weak servo may leave a foot in the air on rough ground, and no more than the tripod needs.
    assert readings['foot_contacts'].sum() >= (6 if name in ('flat', 'slope') else 4)
    assert set(readings['foot_contacts']) <= {0.0, 1.0}
    force = readings['foot_wrench'].sum(axis=0)
    np.testing.assert_allclose(force, [0, 0, robot.TOTAL_MASS * robot.GRAVITY], atol=0.15)


def test_the_height_sensor_reads_the_ground() -> None:
    """Of a level body it is its height above the block under it."""
    simulation = Simulation(world(name='rough', roughness=0.05))
    for x, y in ((0.95, 0.13), (3.22, -1.33), (6.57, 2.11)):
        simulation.data.qpos[:2] = x, y
        simulation.data.qpos[2] = 0.2
        mujoco.mj_forward(simulation.model, simulation.data)
        (height,) = read(simulation, ('height',))['height']
        assert height == pytest.approx(0.2 - simulation.ground(x, y), abs=1e-7)  # float32


def test_the_height_sensor_reads_along_the_normal_of_a_slope() -> None:
    simulation = Simulation(world(name='slope', gradient=0.4))
    angle = math.atan(0.4)
    up = 0.3 * np.array([-math.sin(angle), 0.0, math.cos(angle)])
    simulation.data.qpos[:3] = np.array([2.5, 0.0, 0.8]) + up
    simulation.data.qpos[3:7] = math.cos(angle / 2), 0.0, -math.sin(angle / 2), 0.0
    mujoco.mj_forward(simulation.model, simulation.data)
    assert read(simulation, ('height',))['height'][0] == pytest.approx(0.3, abs=1e-6)


def test_the_task_judges_heights_above_the_ground() -> None:
    """A body at the walking height over a step earns what it earns on the floor."""
    terms, causes = [], []
    for name in ('flat', 'stairs'):
        config = TaskConfig.of_article(min_height=0.1)
        task = LineTask(config, world=world(name=name, rise=0.1))
        task.reset(1)
        x = 3.0
        task.simulation.data.qpos[0] = x
        task.simulation.data.qpos[2] += task.simulation.ground(x, 0.0)
        mujoco.mj_forward(task.simulation.model, task.simulation.data)
        task.simulation.model.opt.gravity[:] = 0.0  # nothing falls in the one period
        outcome = task.advance(NEUTRAL)
        terms.append(outcome.terms['height'])
        causes.append(outcome.cause)
    assert terms[0] == pytest.approx(terms[1], abs=0.02)
    assert terms[0] > -0.2
    assert causes == ['', '']


def test_friction_is_that_of_every_contact() -> None:
    simulation = Simulation(world(name='rough', friction=0.4))
    simulation.data.qpos[0] = 2.0
    simulation.data.qpos[2] += 0.03
    for _ in range(40):
        simulation.advance(NEUTRAL)
    assert simulation.data.ncon
    assert set(simulation.data.contact.friction[:, 0]) == {0.4}


def test_a_walk_beside_the_rough_ground_is_refused() -> None:
    rough = SceneConfig.of_article(name='rough')
    check_walk(rough, HALF_WIDTH - 0.4)
    with pytest.raises(ValueError, match=r'rough.*2.1 m by task.line_y'):
        check_walk(rough, 2.1)
    check_walk(SceneConfig.of_article(), 100.0)


def test_a_task_that_enters_another_world_is_a_new_one() -> None:
    """Episodes after a change equal those of a task that never had another world."""
    rough, seen = world(name='rough', run_up=0.3), []
    for task in (
        LineTask(TaskConfig.of_article()),
        LineTask(TaskConfig.of_article(), world=rough),
    ):
        task.reset(5)
        task.advance(NEUTRAL + 0.1)
        task.enter(rough)
        task.reset(5)
        for _ in range(20):
            outcome = task.advance(NEUTRAL + 0.05)
        seen.append((task.simulation.data.qpos.copy(), outcome.reward))
    np.testing.assert_array_equal(seen[0][0], seen[1][0])
    assert seen[0][1] == seen[1][1]
