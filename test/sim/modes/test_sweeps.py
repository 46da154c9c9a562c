# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""A substep at the limit does what a plain float64 loop over cells and edges does."""

from contextlib import closing

from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import rest_lengths
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest

ROWS, COLS, SUBSTEP, SWEEPS, LIMIT = 7, 10, 1e-3, 4, 0.1
COMPLIANCE, MOST_BACK = 0.03, 0.05
# From and to corner of each edge in its cell, and which rest length is its own.
EDGES = (((0, 0), (0, 1), 0), ((0, 0), (1, 0), 1), ((0, 0), (1, 1), 2), ((0, 1), (1, 0), 2))


def swept_velocities(positions, velocities, free, rests):
    """Return the velocities of nodes of 1 kg after the sweeps, from no tensions."""
    velocities = velocities.copy()
    tensions = {}
    for _ in range(SWEEPS):
        for colour in range(4):
            for row in range(colour >> 1, ROWS, 2):
                for col in range(colour & 1, COLS, 2):
                    for number, (tail, head, rest) in enumerate(EDGES):
                        i = row + tail[0], col + tail[1]
                        j = row + head[0], col + head[1]
                        if max(i[0], j[0]) < ROWS and max(i[1], j[1]) < COLS:
                            key = row, col, number
                            tensions[key] = limit_edge(
                                positions, velocities, free, i, j, rests[rest],
                                tensions.get(key, 0.0))
    return velocities


def limit_edge(positions, velocities, free, i, j, rest, old):
    """Change the velocities of nodes i and j, and return the edge's new tension."""
    movable = float(free[i]) + float(free[j])
    if movable == 0.0:
        return 0.0
    d = positions[j] - positions[i]
    length = np.linalg.norm(d)
    ahead = np.linalg.norm(d + SUBSTEP * (velocities[j] - velocities[i]))
    per_length = 1.0 / (SUBSTEP**2 * movable)
    # A substep as long as this takes all back that is beyond the limit, but for much of it.
    most = max((1.0 + LIMIT) * rest, length - MOST_BACK * rest)
    least = min((1.0 - LIMIT) * rest, length + MOST_BACK * rest)
    pull = max((old + (ahead - most) * per_length) / (1.0 + COMPLIANCE), 0.0)
    press = min((old + (ahead - least) * per_length) / (1.0 + COMPLIANCE), 0.0)
    tension = (pull if old >= 0.0 else 0.0) + (press if old <= 0.0 else 0.0)
    change = (tension - old) * SUBSTEP * d / length
    velocities[i] += free[i] * change
    velocities[j] -= free[j] * change
    return tension


@pytest.mark.parametrize('loads', ['texture', 'storage'])
@pytest.mark.parametrize('block', [1, 4])
def test_sweeps_against_a_loop(loads, block):
    """A compiler's fault, a race between cells, or a wrong neighbour, goes unseen."""
    weak = {
        **{f'stiffness.{family}': 1e-6 for family in FAMILIES},
        **{f'damping.{family}': 0.0 for family in FAMILIES}}
    scene = Scene({
        **weak, 'rows': ROWS, 'cols': COLS, 'width': COLS - 1.0, 'height': ROWS - 1.0,
        'node_mass': 1.0, 'gravity': [0.0, 0.0, 0.0], 'mode': 'adaptive', 'dt': SUBSTEP,
        'auto_substeps': False, 'adaptive.sweeps': SWEEPS, 'adaptive.threshold': LIMIT,
        'loads': loads, 'block': block})
    random = np.random.default_rng(1)
    free = ~scene.pinned_nodes()
    positions = scene.rest_positions() + 0.08 * random.standard_normal((ROWS, COLS, 3))
    velocities = random.standard_normal((ROWS, COLS, 3)) * free[..., None]
    with closing(Simulation(scene)) as simulation:
        simulation.set_state(positions, velocities)
        simulation.step()
        snapshot = simulation.snapshot()
    expected = swept_velocities(
        positions.astype(np.float32).astype(float), velocities.astype(np.float32).astype(float),
        free, rest_lengths(scene))
    changes = np.abs(expected - velocities).max()
    assert changes > 10.0
    assert np.abs(snapshot.velocities - expected).max() < 1e-5 * changes
