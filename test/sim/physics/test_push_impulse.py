# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A push gives its force times its duration, whatever the step."""

import numpy as np
import pytest

NO_EDGES = {'constraint.hard': [], **{
    f'{kind}.{family}': 0.0
    for kind in ('stiffness', 'damping') for family in ('structural', 'shear', 'bend')}}


def _values(mode, layout, dt):
    return {
        **NO_EDGES, 'mode': mode, 'layout': layout, 'rows': 6, 'cols': 5, 'dt': dt,
        'pins': ['top_left'], 'node_mass': 0.01, 'gravity': [0.0, 0.0, 0.0],
        'auto_substeps': False}


@pytest.mark.parametrize('dt', [0.03, 0.007, 0.5])
def test_timed_push(simulate, within, any_mode, layout, dt):
    """The impulse of a push in the scene depends on how its times fall between the steps."""
    force, duration = np.array([0.3, -0.2, 1.5]), 0.2
    simulation = simulate({
        **_values(any_mode, layout, dt), 'pushes.start': [0.11], 'pushes.duration': [duration],
        'pushes.force': force.tolist()})
    simulation.advance(1.5)
    velocities = simulation.snapshot().velocities.astype(float)
    error = np.abs(0.01 * velocities.sum(axis=(0, 1)) - force * duration).max()
    within(f'impulse of a push, dt {dt:g} s, over the impulse', error / 0.3, 1e-6)
    assert not velocities[0, 0].any()


@pytest.mark.parametrize('dt', [0.03, 0.007])
def test_push_in_a_sphere_while_running(simulate, within, mode, layout, dt):
    """A push given between steps reaches other nodes than those in its sphere, or not fully."""
    simulation = simulate(_values(mode, layout, dt))
    simulation.step(3)
    applied = simulation.push(
        (0.0, 0.0, 2.0), region='sphere', center=(0.5, 0.5, 1.0), radius=0.3, duration=0.1)
    simulation.advance(0.5)
    velocities = simulation.snapshot().velocities.astype(float)
    rest = simulation.scene.rest_positions()
    inside = np.linalg.norm(rest - (0.5, 0.5, 1.0), axis=-1) <= 0.3
    assert applied.nodes == inside.sum() > 1
    np.testing.assert_array_equal(velocities[..., 2] > 0.0, inside)
    error = abs(0.01 * velocities[..., 2].sum() - 0.2)
    within(f'impulse of a push in a sphere, dt {dt:g} s, over the impulse', error / 0.2, 1e-6)
    np.testing.assert_allclose(applied.impulse, (0.0, 0.0, 0.2), rtol=1e-12)
    assert simulation.pushes == ()
