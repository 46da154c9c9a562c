# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The values of a scene make the same scene again."""

import json

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.scene_values import given_values
from cloth_sim_ros.study.scene_values import scaled_damping
from cloth_sim_ros.study.scene_values import scaled_stiffness
import pytest
from springs import SPRINGS


@pytest.mark.parametrize('values', [
    {}, {'rows': 5, 'pins': ['none'], 'gravity': [0.0, 0.0, -1.0]},
    {'preset': 'fast'}, {'preset': 'accurate', 'dt': 0.005},
    {'stiffness.structural': [5.0, 7.0]}, {'material.warp': 50.0, 'material.shear': 4.0}])
def test_the_same_scene_again(values):
    """A study would run another scene than it was given."""
    scene = Scene(values)
    again = Scene(json.loads(json.dumps(given_values(scene))))
    assert {**again.values, 'preset': ''} == {**scene.values, 'preset': ''}


def test_defaults_are_left_out():
    """Each line of a study would repeat all parameters."""
    assert given_values(Scene({**SPRINGS, 'rows': 32, 'cols': 7})) == {**SPRINGS, 'cols': 7}


@pytest.mark.parametrize('values', [
    {}, {'stiffness.structural': [5.0, 7.0], 'damping.structural': [0.1, 0.2]},
    {'material.warp': 50.0, 'material.weft': 30.0, 'material.shear': 4.0}])
def test_springs_times_a_factor(values):
    """A study of stiffness would lose what a scene says of warp and weft, or its material."""
    scene = Scene(values)
    scaled = Scene({
        **SPRINGS, **values, **scaled_stiffness(scene, 3.0), **scaled_damping(scene, 2.0)})
    for family in ('structural', 'shear', 'bend'):
        for direction in (0, 1):
            assert scaled.stiffness(family, direction) == pytest.approx(
                3.0 * scene.stiffness(family, direction))
            assert scaled.damping(family, direction) == pytest.approx(
                2.0 * scene.damping(family, direction))
