# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A fabric by name gives weight, stretch and bending, and leaves what a scene says alone."""

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.materials import FABRICS
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_fields import MATERIALS
from cloth_sim_ros.sim.springs import WARP
import pytest


@pytest.mark.parametrize('name', FABRICS)
def test_it_gives_what_is_left_out(name):
    """A named fabric would weigh, stretch or bend like another one."""
    fabric = FABRICS[name]
    scene = Scene({'material.preset': name, 'rows': 21, 'cols': 21})
    assert scene['areal_density'] == fabric.density
    assert scene.stiffness('structural', WARP) + fabric.shear == pytest.approx(fabric.warp)
    assert scene.stiffness('shear') == pytest.approx(fabric.shear)
    # Bend springs would stretch with it.
    assert not scene.models('bend')
    assert scene['bending.rigidity'] == fabric.rigidity
    assert Scene(scene.values).values == scene.values


def test_the_names_are_those_of_the_parameter():
    """A fabric could not be chosen, or a choice would give nothing."""
    assert tuple(FABRICS) == MATERIALS


def test_what_the_scene_says_wins():
    """A weight or a stiffness that was set would be lost."""
    own = Scene({'material.preset': 'denim', 'material.warp': 300.0, 'bending.rigidity': 0.0})
    assert (own['material.warp'], own['material.weft']) == (300.0, 1014.0)
    assert not own.has_rigidity
    weighed = Scene({'material.preset': 'denim', 'total_mass': 0.5})
    assert weighed['areal_density'] == 0.0
    springs = Scene({'material.preset': 'denim', 'stiffness.structural': 50.0})
    assert springs.stiffness('structural') == 50.0
    assert springs['areal_density'] == 0.324


def test_an_unknown_one_is_refused():
    """A mistyped fabric would be passed over in silence."""
    with pytest.raises(ClothSimError, match='material.preset must be one of none, t_shirt'):
        Scene({'material.preset': 'silk'})
