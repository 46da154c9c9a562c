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

"""The constraint mode on the device against the float64 oracle, solved in its dual form."""

from cloth_sim_ros.reference.constraint import ConstraintOptions
from cloth_sim_ros.reference.constraint import ConstraintReference
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

ALL = ('structural', 'shear', 'bend')
FORMS = {
    'one solve': ({'constraint.newton_iterations': 1}, {'newton_iterations': 1}),
    'two solves': ({}, {}),
    'three solves': ({'constraint.newton_iterations': 3}, {'newton_iterations': 3}),
    'bend springs': (
        {'constraint.springs': ['bend'], 'stiffness.bend': 10.0, 'damping.bend': 0.01,
         'constraint.newton_iterations': 3}, {'newton_iterations': 3}),
    'implicit springs': (
        {'constraint.hard': [], 'constraint.springs': ALL, 'stiffness.bend': 10.0,
         'damping.bend': 0.01}, {'hard': ()}),
    'all hard': (
        {'constraint.hard': ALL, 'stiffness.bend': 10.0}, {'hard': ALL}),
}
SCENE = {
    'mode': 'constraint', 'rows': 7, 'cols': 9, 'width': 1.3, 'dt': 0.005, 'start.jitter': 0.1,
    'stiffness.bend': 0.0, 'damping.bend': 0.0, 'pins': ['top_left', '3,8'],
    'solver.tolerance': 1e-6, 'solver.max_iterations': 400, 'auto_substeps': False,
    'pushes.start': [0.0, 0.01], 'pushes.duration': [0.03, 0.05],
    'pushes.force': [0.2, 0.0, 3.0, 0.0, 1.0, 0.0],
    'pushes.center': [0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 'pushes.radius': [0.0, 0.35]}


@pytest.mark.parametrize('loads', ['texture', 'storage'])
@pytest.mark.parametrize('form', FORMS)
def test_steps_and_tensions(simulate, within, form, loads):
    """The step on the device is not (J W J^T + E) lambda = r, solve after solve."""
    changes, options = FORMS[form]
    values = {**SCENE, **changes}
    simulation = simulate({**values, 'loads': loads})
    oracle = ConstraintReference(Scene(values), ConstraintOptions(substeps=1, **options))
    for _ in range(6):
        simulation.step()
        oracle.step()
    snapshot = simulation.snapshot(tension=True)
    assert snapshot.solver_residual <= 1e-6
    speed = np.abs(oracle.velocities).max()
    within('positions [m]', np.abs(snapshot.positions - oracle.positions).max(), 2e-5)
    within('velocities over the largest',
           np.abs(snapshot.velocities - oracle.velocities).max() / speed, 2e-3)
    found = snapshot.tension[_places(oracle)]
    within('tension over the largest',
           np.abs(found - oracle.tension).max() / np.abs(oracle.tension).max(), 2e-3)


def _places(oracle):
    """Return where a Snapshot has the tension of each edge of the oracle: row, column, edge."""
    row, col = np.divmod(oracle.edges.first, oracle.scene.cols)
    last_row, last_col = np.divmod(oracle.edges.second, oracle.scene.cols)
    edges = {(0, 1): 0, (1, 0): 1, (1, 1): 2, (1, -1): 3, (0, 2): 4, (2, 0): 5}
    offsets = zip((last_row - row).tolist(), (last_col - col).tolist())
    return row, col, np.array([edges[offset] for offset in offsets])


def test_substeps_are_those_of_the_reference(simulate):
    """Substeps are not chosen from the turn of edges and their tensions."""
    values = {**SCENE, 'auto_substeps': True, 'dt': 0.02}
    simulation = simulate(values)
    oracle = ConstraintReference(Scene(values))
    chosen = []
    for _ in range(8):
        simulation.step()
        oracle.step()
        chosen.append((simulation.substeps, oracle.substeps))
    assert max(both[0] for both in chosen) > 1
    assert [both[0] for both in chosen] == [both[1] for both in chosen]


def test_the_step_stays_within_its_most_substeps(simulate):
    """A violent push makes a step take forever."""
    simulation = simulate({
        **SCENE, 'auto_substeps': True, 'dt': 0.02, 'constraint.max_substeps': 3,
        'pushes.force': [0.0, 0.0, 500.0, 0.0, 1.0, 0.0]})
    simulation.step(3)
    assert simulation.substeps == 3
