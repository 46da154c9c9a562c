# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The shaders against the float64 oracle, on scenes nobody chose.

How far float32 may stray depends on the scene: a cloth that buckles makes the least rounding
grow. So each scene measures it: a second oracle has its state rounded to float32 after each
substep. The shaders round the forces too, which is worth as much again at the stability limit;
they may stray 10 times as far, plus 8 units in the last place of the farthest coordinate.
"""

from contextlib import closing
from functools import lru_cache
import json

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.sim.model.stability import choose_substeps
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from hypothesis import assume
from hypothesis import given
from hypothesis import settings
from hypothesis import strategies
import numpy as np
import pytest
from springs import SPRINGS

FAMILIES = ('structural', 'shear', 'bend')
# Layout, loads and block of each way through the shaders, and how many scenes it has to do.
# Large blocks compile slowly on software devices.
PATHS = (
    ('paper', 'storage', 1, 3), ('fused', 'storage', 1, 2), ('fused', 'texture', 1, 3),
    ('fused', 'texture', 2, 4), ('fused', 'storage', 2, 1), ('fused', 'texture', 3, 1),
    ('fused', 'texture', 4, 3), ('fused', 'storage', 4, 1),
)
# What the oracle has no use for.
WAYS = ('layout', 'loads', 'block')
MOST_NODES_OF_A_SIDE = 40
MOST_SUBSTEPS = 800


def _numbers(low, high):
    return strategies.floats(low, high).map(lambda value: float(f'{value:.4g}'))


@strategies.composite
def scene_values(draw):
    """Draw scenes of all shapes, stiff and slack, with pins and pushes."""
    rows, cols = draw(strategies.tuples(
        strategies.integers(1, MOST_NODES_OF_A_SIDE),
        strategies.integers(1, MOST_NODES_OF_A_SIDE)).filter(
            lambda shape: shape[0] * shape[1] > 1))
    values = {
        'rows': rows, 'cols': cols, 'width': draw(_numbers(0.2, 3.0)),
        'height': draw(_numbers(0.2, 3.0)), 'areal_density': draw(_numbers(0.05, 2.0)),
        'node_mass': draw(strategies.sampled_from((0.0, 0.0, 0.02))),
        'gravity': [draw(_numbers(-5.0, 5.0)), draw(_numbers(-5.0, 5.0)),
                    draw(_numbers(-10.0, 5.0))],
        'start.pose': draw(strategies.sampled_from(('horizontal', 'hanging'))),
        'start.z': draw(_numbers(-1.0, 2.0)), 'start.jitter': draw(_numbers(0.01, 0.2)),
        'start.seed': draw(strategies.integers(0, 1000)), 'dt': draw(_numbers(0.001, 0.02)),
    }
    mass = Scene({**SPRINGS, **values}).node_mass
    for family in FAMILIES:
        stiffness = draw(strategies.just(0.0) | _numbers(1.0, 1000.0))
        ratio = draw(strategies.just(0.0) | _numbers(0.001, 1.0))
        values[f'stiffness.{family}'] = stiffness
        values[f'damping.{family}'] = ratio * np.sqrt(max(stiffness, 1.0) * mass)
    if draw(strategies.booleans()):
        warp = values['stiffness.structural']
        values['stiffness.structural'] = [warp, draw(_numbers(1.0, 1000.0))]
    node = f'{draw(strategies.integers(0, rows - 1))},{draw(strategies.integers(0, cols - 1))}'
    values['pins'] = draw(strategies.lists(strategies.sampled_from(
        ('none', 'top_left', 'top_right', 'bottom_edge', 'bottom_left', node)), min_size=1))
    assume(not Scene(values).pinned_nodes().all())
    values.update(draw(_pushes(Scene(values))))
    return values


@strategies.composite
def _pushes(draw, scene):
    pushes = {name: [] for name in ('start', 'duration', 'force', 'center', 'radius')}
    weight = scene.node_mass * 9.81
    for _ in range(draw(strategies.integers(0, 3))):
        radius = draw(strategies.just(0.0) | _numbers(0.1, 1.0))
        # A sphere's nodes are those inside when it begins: rounding must not choose them.
        start = 0.0 if radius else draw(_numbers(0.0, 0.4))
        center = scene.rest_positions()[
            draw(strategies.integers(0, scene.rows - 1)),
            draw(strategies.integers(0, scene.cols - 1))]
        distance = np.linalg.norm(scene.start_positions() - center, axis=-1)
        inside = (distance <= radius) & ~scene.pinned_nodes()
        if radius and (np.abs(distance - radius).min() < 1e-4 or not inside.any()):
            continue
        pushed = inside.sum() if radius else scene.node_count
        pushes['start'].append(start)
        pushes['duration'].append(draw(_numbers(0.001, 0.3)))
        pushes['force'] += [
            draw(_numbers(-3.0, 3.0)) * weight * pushed for _ in range(3)]
        pushes['center'] += center.tolist()
        pushes['radius'].append(radius)
    return {f'pushes.{name}': value for name, value in pushes.items()}


@lru_cache(maxsize=16)
def _step_with_twins(written_values, count):
    """
    Run the oracle for ``count`` substeps, and two that are rounded to float32 before each.

    All ways through the shaders get the same first scenes, so that one run serves them all.

    One is rounded to the nearest float, the other up or down at random: what a single one strays
    by is chance where a cloth is on its way to chaos.

    :param written_values: of the scene, as JSON
    :return: the oracle, and the largest difference of the two in positions and in velocities
    """
    scene = Scene(json.loads(written_values))
    exact, nearest, either = (MassSpringReference(scene) for _ in range(3))
    random = np.random.default_rng(0)
    for _ in range(count):
        for name in ('positions', 'velocities'):
            state = getattr(nearest, name)
            setattr(nearest, name, state.astype(np.float32).astype(float))
            state = getattr(either, name)
            setattr(either, name, (
                state + (random.random(state.shape) - 0.5) * np.spacing(state.astype(np.float32))
            ).astype(np.float32).astype(float))
        for cloth in (exact, nearest, either):
            cloth.step()
    return exact, *(
        max(np.abs(getattr(twin, name) - getattr(exact, name)).max()
            for twin in (nearest, either))
        for name in ('positions', 'velocities'))


def _hold_to_reference(values, context):
    """
    Run the scene both ways for up to half a second; fail where they differ by too much.

    :return: the largest difference over what is allowed
    """
    scene = Scene(values)
    substeps = choose_substeps(scene)
    assume(substeps <= MOST_SUBSTEPS // 5)
    steps = max(1, min(int(0.5 / scene['dt']), MOST_SUBSTEPS // substeps))
    of_the_oracle = {
        **{name: value for name, value in values.items() if name not in WAYS},
        'dt': scene['dt'] / substeps, 'auto_substeps': False}
    exact, noise, speed_noise = _step_with_twins(
        json.dumps(of_the_oracle, sort_keys=True), steps * substeps)
    assert np.isfinite(noise), 'automatic substeps let the cloth blow up'
    # Beyond this the scene is chaotic in the time given, and says nothing about the shaders.
    assume(noise < 1e-5)
    with closing(Simulation(scene, context=context)) as simulation:
        assert simulation.substeps == substeps
        simulation.step(steps)
        snapshot = simulation.snapshot()
    last_place = np.finfo(np.float32).eps * np.abs(exact.positions).max()
    # A velocity is worth a change of position by the last place in each substep.
    speed_last_place = last_place / exact.dt + (
        np.finfo(np.float32).eps * np.abs(exact.velocities).max())
    ratios = (
        np.abs(snapshot.positions - exact.positions).max() / (10.0 * noise + 8.0 * last_place),
        np.abs(snapshot.velocities - exact.velocities).max()
        / (10.0 * speed_noise + 8.0 * speed_last_place))
    assert max(ratios) <= 1.0
    return max(ratios)


@pytest.mark.parametrize(('layout', 'loads', 'block', 'scenes'), PATHS)
def test_random_scenes(context, within, unlimited_mode, layout, loads, block, scenes):
    """A spring, a pin, a push or the border is not what the oracle has in its place."""
    ratios = []

    @settings(max_examples=scenes, derandomize=True, deadline=None)
    @given(values=scene_values())
    def check(values):
        ratios.append(_hold_to_reference({
            **values, 'mode': unlimited_mode, 'layout': layout, 'loads': loads, 'block': block},
            context))

    check()
    within(f'random scenes against the oracle, {layout} {loads} {block}', max(ratios), 1.0)


@pytest.mark.parametrize(('nodes', 'seconds', 'allowed'), [
    (16, 0.5, 4e-6), (16, 1.0, 1e-3), (32, 0.45, 4e-5)])
def test_rounding_grows_as_it_does_in_any_cloth(
        simulate, within, mode, nodes, seconds, allowed):
    """The shaders lose more digits than float32 does: trajectories part too early."""
    # Up to the strain limit of mode adaptive, which is not reached by then.
    simulation = simulate({
        'mode': mode, 'rows': nodes, 'cols': nodes, 'dt': 5e-4, 'auto_substeps': False,
        'adaptive.threshold': 0.5})
    oracle = MassSpringReference(simulation.scene)
    simulation.advance(seconds)
    oracle.advance(seconds)
    miss = simulation.snapshot().positions - oracle.positions
    within(f'RMS distance to the oracle, {nodes} x {nodes}, at {seconds:g} s [m]',
           np.sqrt(np.mean(np.sum(miss**2, axis=-1))), allowed)


@pytest.mark.long
@settings(max_examples=300, deadline=None)
@given(values=scene_values(), path=strategies.sampled_from(PATHS))
def test_many_random_scenes(context, unlimited_mode, path, values):
    """The same, on other scenes each time."""
    layout, loads, block, _ = path
    _hold_to_reference({
        **values, 'mode': unlimited_mode, 'layout': layout, 'loads': loads, 'block': block},
        context)
