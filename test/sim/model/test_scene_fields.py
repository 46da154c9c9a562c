# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A field takes what it says and refuses the rest with rule, value and way out."""

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import Field
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS
import pytest

_MASS = Field('mass', float, 1.0, 'a mass', 'kg', low=0.5, high=2.0)


@pytest.mark.parametrize(('value', 'message'), [
    (float('nan'), 'mass must be finite, got nan: give a value from 0.5 to 2 kg'),
    (float('inf'), 'mass must be finite'),
    (3.0, 'mass 3.0 is outside its range: give a value from 0.5 to 2 kg'),
    (0.4, 'mass 0.4 is outside its range'),
    ('heavy', "mass must be a number, got 'heavy'"),
    (True, 'mass must be a number, got True'),
    (None, 'mass must be a number, got None'),
    ([1.0], 'mass must be a number'),
])
def test_bad_values_are_refused(value: object, message: str):
    """A wrong value would reach the simulation or be refused without a reason."""
    with pytest.raises(ClothSimError) as caught:
        _MASS.check(value)
    assert message in str(caught.value)


def test_whole_numbers_pass_as_floats():
    """A user who writes 1 for 1.0 in YAML would be turned away."""
    assert _MASS.check(1) == 1.0
    assert isinstance(_MASS.check(1), float)


def test_a_float_is_no_whole_number():
    """Rows of 3.5 would be cut to 3 silently."""
    with pytest.raises(ClothSimError, match='rows must be a whole number, got 3.5'):
        Field('rows', int, 3, '').check(3.5)


def test_lists_are_checked_element_by_element():
    """A NaN inside a gravity vector would pass."""
    gravity = Field('gravity', float, (0.0,), '', is_array=True)
    assert gravity.check([0, 0.0, -1]) == (0.0, 0.0, -1.0)
    with pytest.raises(ClothSimError, match='gravity must be finite'):
        gravity.check([0.0, float('nan'), 0.0])
    with pytest.raises(ClothSimError, match='gravity must be a list'):
        gravity.check('down')


@pytest.mark.parametrize(('name', 'value', 'message'), [
    ('pins', [100, 100], 'pins must be a word, got 100: give none, all, top_left, top_right, '
     'bottom_left, bottom_right, top_edge, bottom_edge, or a node as "row,col"'),
    ('pins', 'top_left', 'pins must be a list, got \'top_left\': write ["top_left"]'),
    ('pins', '3,4', 'pins must be a list, got \'3,4\': write ["3,4"]'),
    ('pin_moves.node', [3], 'node must be a word, got 3: give a corner, or a node as "row,col"'),
    ('gravity', 9.81, 'gravity must be a list, got 9.81: write [...], as in [0.0, 0.0, -9.81]'),
    ('pushes.start', 1.0, 'pushes.start must be a list, got 1.0: write [...]'),
    ('constraint.hard', [3], 'constraint.hard must be one of structural, shear, bend, got 3'),
])
def test_a_wrong_value_is_told_what_to_write(name: str, value: object, message: str):
    """A user would know that it is wrong, and not what is right."""
    field = next(field for field in SCENE_FIELDS if field.name == name)
    with pytest.raises(ClothSimError) as caught:
        field.check(value)
    assert str(caught.value).endswith(message)


@pytest.mark.parametrize('field', SCENE_FIELDS, ids=lambda field: field.name)
def test_defaults_pass_their_own_check(field: Field):
    """A scene without parameters would be refused."""
    assert field.check(field.default) == field.default
    assert field.text
