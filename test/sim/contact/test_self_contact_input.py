# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a scene with self-contact is refused for, and warned of."""

from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.validation.layers import layered_scene
from cloth_sim_ros.validation.layers import stacked
from cloth_sim_ros.validation.layers import THICKNESS
import numpy as np
import pytest

TOUCHING = {'rows': 8, 'cols': 8, 'width': 0.14, 'height': 0.14, 'self_contact.enabled': True}


@pytest.mark.parametrize(('values', 'words'), [
    ({'self_contact.thickness': 0.0}, 'self_contact.thickness'),
    ({'self_contact.thickness': float('nan')}, 'self_contact.thickness'),
    ({'self_contact.thickness': 0.0101}, 'above half a cell, 0.01 m'),
    ({'self_contact.friction': -0.1}, 'self_contact.friction'),
    ({'self_contact.friction': float('nan')}, 'self_contact.friction'),
    ({'layout': 'paper'}, 'set layout: fused'),
    ({'adaptive.scheme': 'paper'}, 'set adaptive.scheme: constraint'),
    ({'rows': 1}, 'has no surface'),
])
def test_wrong_values_are_refused(values, words):
    """A run would start with a contact that does nothing."""
    with pytest.raises(ClothSimError) as refusal:
        Scene({**TOUCHING, **values})
    assert words in str(refusal.value)
    assert str(refusal.value).count('\n') == 0


def test_steps_of_the_whole_cloth_are_refused():
    """Layers would pass each other in silence."""
    whole = {**TOUCHING, 'adaptive.scheme': 'whole'}
    with pytest.raises(ClothSimError, match='adaptive.scheme whole has substeps in which layers'):
        Simulation(Scene({**whole, 'mode': 'adaptive'}))
    with Simulation(Scene(whole)) as cloth:
        cloth.step(1)
        with pytest.raises(ClothSimError, match='set adaptive.scheme: constraint'):
            cloth.set_mode('adaptive')
        cloth.step(1)
        assert cloth.mode == Scene(whole)['mode']


@pytest.mark.parametrize('mode', ['mass_spring', 'adaptive', 'constraint'])
def test_layers_stay_apart_when_the_mode_changes(mode):
    """A switch would drop the layers that lie on each other through each other."""
    scene = layered_scene(2, 8, pins=[f'{row},{col}' for row in range(8) for col in range(8)])
    with Simulation(scene) as cloth:
        positions = stacked(scene, 2)
        cloth.set_state(positions, np.zeros_like(positions))
        for each in ('mass_spring', mode, 'mass_spring'):
            cloth.set_mode(each)
            cloth.advance(0.1)
            assert cloth.snapshot().surface_contact_held
            apart = cloth.positions()[10:14, 2:6, 2] / THICKNESS
            np.testing.assert_allclose(apart, 1.0, atol=0.01)


def test_crossings_at_the_start_are_said():
    """What begins inside itself would stay so, and all would seem well."""
    with Simulation(Scene({**TOUCHING, 'pins': ['none'], 'gravity': [0.0, 0.0, 0.0]})) as cloth:
        positions = cloth.positions().astype(float)
        # The last two columns stand upright in the middle of the others.
        positions[:, 6:, 0] = positions[:, 2:3, 0] + 0.007
        positions[:, 5, 2] += 0.02
        positions[:, 6, 2] += 0.01
        positions[:, 7, 2] -= 0.01
        cloth.set_state(positions, np.zeros_like(positions))
        with pytest.warns(UserWarning, match='begins with [0-9]+ edges that pass through it'):
            cloth.step(1)
        assert not cloth.snapshot().surface_contact_held
