# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A cloth that hangs still: its edges carry what is below them, its pins carry all."""

from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
import numpy as np
import pytest

MASS, GRAVITY = 0.01, 9.81
# Stiff enough to come to rest soon, and damped.
HANGING = {
    'start.pose': 'hanging', 'start.z': -0.25, 'height': 0.5, 'width': 0.3, 'node_mass': MASS,
    'stiffness.structural': 100.0, 'stiffness.shear': 100.0, 'stiffness.bend': 10.0,
    'damping.structural': 1.0, 'damping.shear': 1.0, 'damping.bend': 0.1, 'dt': 0.0025}


@pytest.mark.parametrize('cols', [pytest.param(1, marks=pytest.mark.long), 3])
def test_edges_carry_the_weight_below_them(simulate, within, force_scene, cols):
    """A tension is not the weight it carries, or is reported for another edge."""
    rows = 8
    simulation = simulate(
        {**HANGING, 'rows': rows, 'cols': cols, 'pins': ['top_edge'], **force_scene})
    simulation.advance(2.5)
    snapshot = simulation.snapshot(tension=True)
    down = -snapshot.positions[..., 2].astype(float)
    carried = np.zeros(rows - 1)
    for kind in EDGE_KINDS:
        starts, ends = kind.everywhere(rows, cols)
        length = np.linalg.norm(
            snapshot.positions[ends].astype(float) - snapshot.positions[starts], axis=-1)
        pull = snapshot.tension[(*starts, kind.number)] * (down[ends] - down[starts]) / length
        # An edge is cut by each gap between rows that it spans.
        for first, pulls in enumerate(pull.sum(axis=1)):
            carried[first:first + kind.drow] += pulls
    below = cols * MASS * GRAVITY * np.arange(rows - 1, 0, -1)
    within(f'{cols} wide, pull across each row over the weight below it',
           np.abs(carried / below - 1.0).max(), 1e-3)


@pytest.mark.parametrize('pins', [
    pytest.param(['top_edge'], marks=pytest.mark.long), ['top_left', 'top_right', '3,2']], ids=len)
def test_pins_carry_the_weight(simulate, within, force_scene, pins):
    """The pins do not hold the cloth's weight, their own nodes' with it."""
    simulation = simulate({**HANGING, 'rows': 6, 'cols': 5, 'pins': pins, **force_scene})
    simulation.advance(1.8)
    held = simulation.snapshot(pin_forces=True).pin_forces
    assert np.array_equal(held.nodes, np.argwhere(simulation.pinned_nodes()))
    weight = 30 * MASS * GRAVITY
    within('sum of the forces on the pins less the weight, over it',
           np.abs(held.forces.sum(axis=0) + [0.0, 0.0, weight]).max() / weight, 1e-3)
