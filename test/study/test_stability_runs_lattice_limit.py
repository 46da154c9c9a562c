# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The limit of a lattice with edges and corners, against chains that have a closed form."""

from cloth_sim_ros.sim.model.stability import stability_limit
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.stability_runs import lattice_limit
import numpy as np
import pytest
from springs import SPRINGS

UNDAMPED = {f'damping.{family}': 0.0 for family in ('structural', 'shear', 'bend')}


@pytest.mark.parametrize('damping', [0.0, 0.05, 5.0])
@pytest.mark.parametrize('nodes', [2, 5, 40])
def test_a_free_chain_has_a_closed_form(nodes, damping):
    """Predictions for small cloths would be off."""
    stiffness, mass = 100.0, 0.01
    scene = Scene({
        **SPRINGS, 'rows': 1, 'cols': nodes, 'node_mass': mass, 'stiffness.bend': 0.0, **UNDAMPED,
        'stiffness.structural': stiffness, 'damping.structural': damping})
    most = 2.0 + 2.0 * np.cos(np.pi / nodes)
    exact = max(np.roots([most * stiffness, 2.0 * most * damping, -4.0 * mass]))
    assert lattice_limit(scene) == pytest.approx(exact, rel=1e-3)


def test_a_large_cloth_comes_to_the_endless_one():
    """One of the two limits would be wrong."""
    scene = Scene({**SPRINGS, 'rows': 40, 'cols': 40})
    assert 1.0 <= lattice_limit(scene) / stability_limit(scene) < 1.005


def test_no_springs_have_no_limit():
    """A cloth without springs would have a limit."""
    scene = Scene({**SPRINGS, **UNDAMPED, **{
        f'stiffness.{family}': 0.0 for family in ('structural', 'shear', 'bend')}})
    assert lattice_limit(scene) == np.inf
