# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Small cloths that a GPU steps several times in one dispatch."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.modes.mass_spring import MassSpring
from cloth_sim_ros.sim.modes.mass_spring import OnePass
from cloth_sim_ros.sim.modes.spring_tiles import SpringTiles
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
import numpy as np
import pytest
from springs import SPRINGS

SUBSTEPS = 40
SHAPES = [(1, 5), (9, 12), (16, 16), (17, 16), (3, 32), (32, 32)]
FEATURES: Mapping[str, Mapping[str, Any]] = {
    'springs': {}, 'undamped': {f'damping.{name}': 0.0 for name in (
        'structural', 'shear', 'bend')},
    'structural alone': {'stiffness.shear': 0.0, 'stiffness.bend': 0.0, 'damping.shear': 0.0,
                         'damping.bend': 0.0},
    'no pins': {'pins': ['none']}}


@pytest.fixture(scope='module')
def context():
    """Make a context for all tests."""
    made = Context(single_thread=True)
    yield made
    made.close()


def scene_of(rows: int, cols: int, values: Mapping[str, Any]) -> Scene:
    """Return a moving cloth of springs."""
    return Scene({**SPRINGS, 'rows': rows, 'cols': cols, 'start.jitter': 0.1, 'dt': 0.001,
                  **values})


def states_after(scene: Scene, layout: Layout, starts: np.ndarray, pinned: np.ndarray,
                 present: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return positions and velocities after SUBSTEPS, in single passes and in one dispatch."""
    found = []
    for passes in (OnePass(scene, layout), SpringTiles(scene, layout)):
        state = State(layout, starts, pinned, present)
        passes.substeps(state, Forcing(scene['gravity']), 0.0005, SUBSTEPS)
        found.append((state.read_positions(), state.read_velocities()))
        state.delete()
        passes.delete()
    return found


@pytest.mark.parametrize('features', FEATURES)
@pytest.mark.parametrize(('rows', 'cols'), SHAPES)
def test_bits_of_single_substeps(context, rows: int, cols: int, features: str):
    """A run would depend on how many substeps were made at once."""
    scene = scene_of(rows, cols, FEATURES[features])
    layout = choose_layout(scene, context, tuned=False)
    assert SpringTiles.can_run(scene, layout)
    start, pinned = scene.start_positions(), scene.pinned_nodes()
    one, other = states_after(scene, layout, start, pinned, np.ones_like(pinned))
    assert np.abs(one[1]).max() > 0.01
    for single, tiled in zip(one, other):
        np.testing.assert_array_equal(single, tiled)


def test_bits_of_each_cloth_in_a_stack(context):
    """A cloth would feel the one below it, or miss a dispatch."""
    scene = scene_of(10, 7, {})
    layout = choose_layout(scene, context, tuned=False).stacked(5, context)
    rows = np.arange(5)[:, None] * layout.period + np.arange(scene.rows)
    starts = np.zeros((layout.rows, scene.cols, 3))
    pinned = np.zeros((layout.rows, scene.cols), dtype=bool)
    present = np.zeros_like(pinned)
    for seed, own in enumerate(rows):
        starts[own] = Scene({**scene.values, 'start.seed': seed}).start_positions()
        pinned[own] = scene.pinned_nodes()
        present[own] = True
    one, other = states_after(scene, layout, starts, pinned, present)
    for single, tiled in zip(one, other):
        np.testing.assert_array_equal(single[rows], tiled[rows])


@pytest.mark.parametrize('values', [
    {'rows': 33}, {'bending.rigidity': 1e-4}, {'air.density': 1.2}, {'dt': 1e-6},
    {'colliders.names': ['a'], 'colliders.a.shape': 'plane'}, {'layout': 'paper'}])
def test_what_a_tile_does_not_model(context, values: Mapping[str, Any]):
    """A load would be left out without a word."""
    scene = scene_of(12, 12, values)
    assert not SpringTiles.can_run(scene, choose_layout(scene, context, tuned=False))


def test_a_mode_uses_it_beside_the_host_alone(context):
    """llvmpipe, which takes ten times as long for it, would compile and run it."""
    scene = scene_of(12, 12, {})
    layout = choose_layout(scene, context, tuned=False)
    for is_asynchronous, most in ((False, 64), (True, 256)):
        mode = MassSpring(scene, replace(layout, is_asynchronous=is_asynchronous))
        assert mode.checked_substeps == most
        mode.delete()
