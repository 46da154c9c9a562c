# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
A sheet that is pulled or sheared measures the stiffness of its material.

Free nodes are put where a sheet under uniform strain has them. Then only those at a border are
accelerated, and what drives the nodes of one side over its width is the stress. The corners are
left out: where springs are given, each has a whole spring for half a cell.
"""

import numpy as np
import pytest

STRAIN = 0.004
DT = 1e-5
WARP, WEFT, SHEAR = 100.0, 60.0, 30.0
MATERIAL = {'material.warp': WARP, 'material.weft': WEFT, 'material.shear': SHEAR}
SHEETS = {
    'springs': {'stiffness.structural': [WARP - SHEAR, WEFT - SHEAR], 'stiffness.shear': SHEAR},
    'material in oblong cells': {**MATERIAL, 'width': 1.2, 'height': 1.0}}


@pytest.fixture(params=[16, 64])
def nodes(request):
    """Return how many nodes a sheet has along each side."""
    return request.param


@pytest.fixture(params=SHEETS.values(), ids=SHEETS)
def forces(request, simulate, nodes, any_mode):
    """Return a function from a gradient of displacements to spacing and forces on nodes [N]."""
    simulation = simulate({
        'mode': any_mode, 'rows': nodes, 'cols': nodes, 'gravity': [0.0, 0.0, 0.0],
        'start.z': 0.0, 'dt': DT, 'constraint.hard': [], 'solver.tolerance': 1e-4,
        'constraint.springs': ['structural', 'shear'], 'stiffness.bend': 0.0,
        'damping.bend': 0.0, 'pins': ['none'], **request.param})

    def pull(gradient):
        rest = simulation.scene.rest_positions()
        moved = rest[..., :2] + rest[..., :2] @ np.array(gradient)
        simulation.set_state(
            np.concatenate((moved, rest[..., 2:]), axis=-1).astype(np.float32),
            np.zeros(rest.shape, dtype=np.float32))
        simulation.step()
        velocities = simulation.snapshot().velocities.astype(float)
        masses = simulation.scene.node_mass * simulation.scene.node_shares[..., None]
        return simulation.scene.spacing, masses / DT * velocities

    return pull


def test_uniaxial_stretch(forces, within, nodes):
    """A cloth pulled along warp or weft does not pull with K - C12^2 / K of the other one."""
    for axis, (stiff, other) in enumerate(((WARP, WEFT), (WEFT, WARP))):
        gradient = np.diag([-STRAIN * SHEAR / other] * 2)
        gradient[axis, axis] = STRAIN
        spacing, found = forces(gradient)
        # Forces on the right side, which is pulled back, or on the upper one.
        side = found[1:-1, -1, 0] if axis == 0 else found[0, 1:-1, 1]
        measured = -side.mean() / spacing[1 - axis] / STRAIN
        exact = stiff - SHEAR**2 / other
        within(f'{nodes} nodes, uniaxial stretch measures {measured:.2f} for {exact:.2f} N/m',
               abs(measured / exact - 1.0), 0.01)
        inside = np.abs(found[1:-1, 1:-1]).mean()
        within('force on a node inside over that at the side', inside / abs(side.mean()), 0.01)


def test_pure_shear(forces, within, nodes):
    """A cloth sheared in its plane does not resist with G."""
    spacing, found = forces(np.array([[0.0, 0.0], [STRAIN, 0.0]]))
    measured = -found[0, 1:-1, 0].mean() / spacing[0] / STRAIN
    within(f'{nodes} nodes, pure shear measures {measured:.2f} for {SHEAR:.2f} N/m',
           abs(measured / SHEAR - 1.0), 0.01)
