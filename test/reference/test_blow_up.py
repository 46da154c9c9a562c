# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where the oracle blows up, found by bisection, against where that was predicted."""

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.sim.model.stability import stability_limit
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest


def _blows_up(values, dt):
    cloth = MassSpringReference(Scene({**values, 'dt': dt}))
    with np.errstate(over='ignore', invalid='ignore'):
        for _ in range(20):
            cloth.step(50)
            if not cloth.node_strain().max() < 0.3:
                return True
    return False


@pytest.mark.long
@pytest.mark.parametrize(('shear', 'bend'), [(1.0, 1.0), (1.0, 0.1), (0.5, 4.0)])
@pytest.mark.parametrize('damping_ratio', [0.0, 0.2, 5.0])
@pytest.mark.parametrize(('rows', 'cols', 'width'), [(12, 12, 1.0), (20, 24, 1.3)])
def test_predicted_limit(rows, cols, width, shear, bend, damping_ratio):
    """The limit is predicted for another scheme, lattice or damping."""
    stiffness = 100.0
    mass = 0.2 * width / (rows * cols)
    damping = 2.0 * damping_ratio * np.sqrt(stiffness * mass / 10.0)
    values = {
        'rows': rows, 'cols': cols, 'width': width, 'gravity': [0.0, 0.0, 0.0],
        'start.jitter': 1e-4, 'auto_substeps': False,
        'stiffness.structural': stiffness, 'damping.structural': damping,
        'stiffness.shear': stiffness * shear, 'damping.shear': damping * shear,
        'stiffness.bend': stiffness * bend, 'damping.bend': damping * bend}
    limit = stability_limit(Scene(values))
    stable, unstable = 0.7, 1.5
    for _ in range(7):
        middle = np.sqrt(stable * unstable)
        if _blows_up(values, middle * limit):
            unstable = middle
        else:
            stable = middle
    print(f'measured {stable:.3f} of 0.99 to 1.1 allowed: blow-up over prediction')
    assert 0.99 < stable < 1.1
