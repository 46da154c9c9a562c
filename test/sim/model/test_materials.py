# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The stiffness of springs, as a scene says or as it follows from a material or fabric."""

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.model.materials import FABRICS
from cloth_sim_ros.sim.model.materials import WARP
from cloth_sim_ros.sim.model.materials import WEFT
from cloth_sim_ros.sim.model.scene_fields import MATERIALS
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest
from springs import SPRINGS

MATERIAL = {'material.warp': 90.0, 'material.weft': 60.0, 'material.shear': 20.0}
GRIDS = (
    {'rows': 11, 'cols': 11}, {'rows': 64, 'cols': 64}, {'rows': 9, 'cols': 12, 'height': 0.7})


@pytest.mark.parametrize('grid', GRIDS)
@pytest.mark.parametrize('strain', [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0),
                                    (0.3, -0.7, 0.4)])
def test_a_cell_stores_what_the_material_does(grid, strain):
    """A cloth would be stiffer or softer with another grid, or with cells that are no squares."""
    scene = Scene({**SPRINGS, **MATERIAL, **grid, 'stiffness.bend': 0.0})
    along, down, shear = strain
    dx, dy = scene.spacing
    stored = 0.0
    for kind in EDGE_KINDS:
        d = np.array([kind.dcol * dx, kind.drow * dy])
        stretch = d @ np.array([[along, shear / 2], [shear / 2, down]]) @ d / np.hypot(*d)
        stored += 0.5 * kind.stiffness(scene) * stretch**2
    sheet = 0.5 * (90.0 * along**2 + 60.0 * down**2 + 2.0 * 20.0 * along * down + 20.0 * shear**2)
    assert stored / (dx * dy) == pytest.approx(sheet)


def test_square_cells_have_the_difference_of_both():
    """The springs would not be those that the pages tell to those who set them by hand."""
    scene = Scene({**SPRINGS, **MATERIAL, 'rows': 21, 'cols': 21})
    assert scene.stiffness('structural', WARP) == pytest.approx(70.0)
    assert scene.stiffness('structural', WEFT) == pytest.approx(40.0)
    assert scene.stiffness('structural') == pytest.approx(70.0)
    assert scene.stiffness('shear') == pytest.approx(20.0)
    # Bend springs stretch, too, unless the scene asks for them.
    assert not scene.models('bend')
    assert Scene({**SPRINGS, **MATERIAL, 'stiffness.bend': 5.0}).stiffness('bend') == 5.0


def test_one_value_is_that_of_both_directions():
    """A scene with one value would have other springs than before."""
    for values in ({'stiffness.structural': 70.0}, {'stiffness.structural': [70.0, 70.0]},
                   {'material.warp': 90.0, 'material.shear': 20.0}):
        scene = Scene({**SPRINGS, 'rows': 5, 'cols': 5, **values})
        assert [scene.stiffness('structural', part) for part in (WARP, WEFT)] == [
            pytest.approx(70.0)] * 2


def test_a_chain_has_no_diagonals():
    """A chain of a material would be softer than it by what diagonals have elsewhere."""
    chain = Scene({**SPRINGS, **MATERIAL, 'rows': 1, 'cols': 11, 'width': 2.0, 'height': 0.5})
    assert chain.stiffness('structural', WARP) == pytest.approx(90.0 * 0.5 / 0.2)


def test_a_scene_made_again_is_the_same():
    """A recording of a material could not be run again: its springs would stand beside it."""
    for values in (MATERIAL, {'stiffness.structural': [5.0, 7.0]}):
        scene = Scene(values)
        assert Scene(scene.values).values == scene.values


@pytest.mark.parametrize(('values', 'message'), [
    ({**MATERIAL, 'stiffness.shear': 5.0},
     'stiffness.shear 5 and material.warp 90 both say how the cloth stretches: give one of them, '
     'and set the other to 0'),
    ({**MATERIAL, 'stiffness.structural': [5.0, 0.0]}, 'stiffness.structural [5, 0] and'),
    ({'material.weft': 60.0},
     'material.weft 60 stands without material.warp: give that too, in N/m'),
    ({**MATERIAL, 'rows': 11, 'cols': 11, 'width': 3.0},
     'material.shear 20 needs diagonals that are stiffer along the cloth than its material, in '
     'cells of 0.3 x 0.1 m: take at most 10, cells that are nearer to squares, or springs'),
    ({'stiffness.structural': [1.0, 2.0, 3.0]},
     'stiffness.structural takes one value, or one for warp and one for weft, got 3: write a '
     'number or [warp, weft]'),
    ({'damping.structural': [1.0, -2.0]}, 'damping.structural -2.0 is outside its range'),
    ({'stiffness.shear': [1.0, 2.0]}, 'stiffness.shear must be a number'),
])
def test_what_contradicts_itself_is_refused(values, message):
    """One of two values would be passed over in silence, or a cloth pushed apart by a spring."""
    with pytest.raises(ClothSimError) as caught:
        Scene(values)
    assert message in str(caught.value)


# A fabric by name gives weight, stretch and bending, and leaves what a scene says alone.


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
