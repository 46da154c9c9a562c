# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pushes and pins that come while the cloth moves, against the oracle."""

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import Scene
import numpy as np
from springs import SPRINGS

VALUES = {**SPRINGS, 'rows': 11, 'cols': 14, 'width': 1.3, 'dt': 0.003, 'start.jitter': 0.02,
          'damping.structural': 0.03}


def _distance_to_border(positions, push):
    away = np.linalg.norm(positions - np.array(push.center), axis=-1)
    return np.abs(away - push.radius).min()


def test_sphere_push_selects_nodes_at_its_start(simulate, within, mode, layout):
    """A push in a sphere would act on the nodes of the start pose, or of other pushes."""
    pushes = [
        Push((0.0, 0.3, 1.0), 0.2, 0.1, 'sphere', (0.1, 0.3, 0.85), 0.323),
        Push((0.2, 0.0, -0.5), 0.215, 0.2, 'sphere', (-0.3, 0.2, 0.9), 0.305),
        Push((0.0, 0.0, 0.4), 0.25, 0.021, 'all'),
    ]
    values = {
        **VALUES, 'mode': mode, 'layout': layout,
        'pushes.start': [push.start for push in pushes],
        'pushes.duration': [push.duration for push in pushes],
        'pushes.force': [part for push in pushes for part in push.force],
        'pushes.center': [part for push in pushes for part in push.center],
        'pushes.radius': [push.radius for push in pushes]}
    oracle = MassSpringReference(Scene(values))
    simulation = simulate(values)
    for _ in range(150):
        oracle.step()
        for push in pushes[:2]:
            if oracle.time <= push.start < oracle.time + oracle.dt:
                assert _distance_to_border(oracle.positions, push) > 1e-3
    simulation.step(150)
    snapshot = simulation.snapshot()
    within('pushes in motion, against the oracle [m]',
           np.abs(snapshot.positions - oracle.positions).max(), 1e-5)
    still = MassSpringReference(Scene({**SPRINGS, **VALUES}))
    still.step(150)
    assert np.abs(still.positions - oracle.positions).max() > 0.01


def test_pins_set_and_released_while_running(simulate, within, mode, layout):
    """A node pinned in motion keeps moving or pulling, or a released one stays."""
    simulation = simulate({**VALUES, 'mode': mode, 'layout': layout})
    oracle = MassSpringReference(simulation.scene)
    simulation.step(60)
    oracle.step(60)
    simulation.pin(7, 3)
    oracle.free[7, 3] = False
    oracle.velocities[7, 3] = 0.0
    held = simulation.snapshot().positions[7, 3].copy()
    simulation.step(40)
    oracle.step(40)
    simulation.release(0, 0)
    oracle.free[0, 0] = True
    simulation.push((0.0, 0.0, 0.8), duration=0.05)
    oracle.push(Push((0.0, 0.0, 0.8), oracle.time, 0.05))
    simulation.step(40)
    oracle.step(40)
    snapshot = simulation.snapshot()
    np.testing.assert_array_equal(snapshot.positions[7, 3], held)
    assert snapshot.positions[0, 0, 2] != 1.0
    np.testing.assert_array_equal(simulation.pinned_nodes(), ~oracle.free)
    within('pins in motion, against the oracle [m]',
           np.abs(snapshot.positions - oracle.positions).max(), 1e-5)


def test_two_simulations_at_once(simulate, any_mode):
    """Two cloths of one process share a buffer or a context."""
    alone = simulate({**VALUES, 'mode': any_mode})
    alone.advance(0.3)
    expected = alone.snapshot().state_sha256
    alone.close()
    first = simulate({**VALUES, 'mode': any_mode})
    second = simulate({**VALUES, 'mode': any_mode, 'rows': 5, 'gravity': [1.0, 2.0, 3.0]})
    for _ in range(10):
        first.advance(0.03)
        second.advance(0.03)
    assert first.snapshot().state_sha256 == expected
    assert second.snapshot().positions.shape == (5, 14, 3)
