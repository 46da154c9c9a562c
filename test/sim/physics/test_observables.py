# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a snapshot says about its positions and velocities, against float64 NumPy."""

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
import numpy as np
import pytest

SCENES = {
    'square': {'rows': 20, 'cols': 20},
    'wide': {'rows': 7, 'cols': 33, 'width': 2.3, 'pins': ['top_edge']},
    'tall and upright': {'rows': 41, 'cols': 6, 'height': 1.7, 'start.pose': 'hanging'},
    'no shear': {'rows': 9, 'cols': 8, 'stiffness.shear': 0.0, 'damping.shear': 0.0},
    'two rows': {'rows': 2, 'cols': 5},
    'chain': {'rows': 1, 'cols': 9},
    'upright chain': {'rows': 9, 'cols': 1, 'start.pose': 'hanging'},
}


@pytest.fixture(params=SCENES.values(), ids=SCENES.keys())
def observed(request, simulate, mode, layout):
    """Return a scene's snapshot in motion and the oracle in the same state."""
    simulation = simulate({
        **request.param, 'mode': mode, 'layout': layout, 'start.jitter': 0.1, 'dt': 0.002})
    simulation.advance(0.3)
    snapshot = simulation.snapshot()
    oracle = MassSpringReference(simulation.scene)
    oracle.positions = snapshot.positions.astype(float)
    oracle.velocities = snapshot.velocities.astype(float)
    return snapshot, oracle


def _central_differences(positions, axis):
    return np.gradient(positions, axis=axis) if positions.shape[axis] > 1 else (
        np.zeros_like(positions))


def test_energies(observed, within):
    """An energy leaves out a spring or a node, or counts one twice."""
    snapshot, oracle = observed
    energies = oracle.energies()
    scale = abs(energies.kinetic) + abs(energies.elastic) + abs(energies.gravitational)
    for name in ('kinetic', 'elastic', 'gravitational', 'total'):
        error = abs(getattr(snapshot, f'{name}_energy') - getattr(energies, name))
        within(f'{name} energy, over the sum of all', error / scale, 2e-6)
    assert energies.kinetic > 0.0
    assert energies.elastic > 0.0


def test_strain(observed, within):
    """A node's strain is not the largest of its structural and shear springs."""
    snapshot, oracle = observed
    strain = oracle.node_strain()
    within('strain at each node', np.abs(snapshot.strain - strain).max(), 2e-6)
    within('largest strain', abs(snapshot.max_strain - strain.max()), 2e-6)


def test_normals(observed, within):
    """A normal is not the unit cross product of the cloth's two directions there."""
    snapshot, oracle = observed
    down = _central_differences(oracle.positions, 0)
    right = _central_differences(oracle.positions, 1)
    normals = np.cross(down, right)
    length = np.linalg.norm(normals, axis=-1, keepdims=True)
    has_sides = 1 not in snapshot.strain.shape
    normals = normals / length if has_sides else np.broadcast_to([0.0, 0.0, 1.0], normals.shape)
    within('normals', np.abs(snapshot.normals - normals).max(), 1e-5)


def test_records_are_what_the_arrays_show(observed):
    """The message body and the arrays of a snapshot are two different states."""
    snapshot, oracle = observed
    for names, vectors in (('xyz', snapshot.positions), (('vx', 'vy', 'vz'), snapshot.velocities)):
        for axis, name in enumerate(names):
            np.testing.assert_array_equal(snapshot.records[name], vectors[..., axis])
    pinned = (snapshot.flags & 1).astype(bool)
    np.testing.assert_array_equal(pinned, ~oracle.free)
    assert snapshot.finite


def test_a_cloth_larger_than_one_look(simulate, within, mode):
    """A wide cloth is looked at in pieces, and one is left out, doubled or out of place."""
    # The solver of mode adaptive does not fit so many nodes into the buffers of some devices.
    cols = 8192 if mode == 'mass_spring' else 5600
    simulation = simulate({
        'mode': mode, 'rows': 101, 'cols': cols, 'width': cols / 100.0, 'start.jitter': 0.2})
    snapshot = simulation.snapshot()
    oracle = MassSpringReference(simulation.scene)
    np.testing.assert_array_equal(snapshot.positions, oracle.positions.astype(np.float32))
    oracle.positions = snapshot.positions.astype(float)
    energies = oracle.energies()
    for name in ('elastic', 'gravitational'):
        error = getattr(snapshot, f'{name}_energy') / getattr(energies, name) - 1.0
        within(f'{name} energy of {101 * cols} nodes, relative', abs(error), 1e-6)
    within(f'strain at each of {101 * cols} nodes',
           np.abs(snapshot.strain - oracle.node_strain()).max(), 2e-6)
