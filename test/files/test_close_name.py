# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which name was probably meant by a mistyped one."""

from cloth_sim_ros.files.close_name import close_name
from cloth_sim_ros.files.close_name import edits
from cloth_sim_ros.files.close_name import refuse_unknown
from cloth_sim_ros.files.errors import ClothSimError
from hypothesis import given
from hypothesis import strategies
import pytest

KNOWN = ('rows', 'cols', 'width', 'stiffness.shear', 'run', 'real_time_factor')
WORDS = strategies.text('abc', max_size=6)


@pytest.mark.parametrize(('name', 'meant'), [
    ('rwos', 'rows'), ('rnu', 'run'), ('colums', 'cols'), ('widht', 'width'),
    ('stiffnes.sheer', 'stiffness.shear'), ('realtimefactor', 'real_time_factor'),
    ('holes', None), ('sews', None), ('friction', None), ('', None), ('a' * 10_000, None)])
def test_a_slip_is_understood_and_another_word_is_not(name, meant):
    """A user would be led to a parameter that has nothing to do with what was asked for."""
    assert close_name(name, KNOWN) == meant


def test_an_unknown_name_is_refused_with_a_way_out():
    """A typing error would be taken for a wish to do nothing."""
    refuse_unknown('field', ['rows', 'run'], iter(KNOWN))
    with pytest.raises(ClothSimError, match="there is no field 'rwos': did you mean rows?"):
        refuse_unknown('field', ['run', 'rwos'], KNOWN)
    with pytest.raises(ClothSimError, match='take one of rows, cols'):
        refuse_unknown('field', ['friction'], KNOWN)


@given(WORDS, WORDS)
def test_slips_are_counted_alike_from_both_sides(name, other):
    """The count would depend on which of the two is the mistyped one."""
    assert edits(name, other) == edits(other, name)
    assert (edits(name, other) == 0) == (name == other)
    assert abs(len(name) - len(other)) <= edits(name, other) <= max(len(name), len(other))


@given(WORDS, strategies.integers(0, 6), strategies.sampled_from('abcd'))
def test_one_slip_counts_as_one(name, place, char):
    """A character too many, missing, other or in the wrong place would count as several."""
    place = min(place, len(name))
    assert edits(name[:place] + char + name[place:], name) == 1
    swapped = name[:place] + name[place:place + 2][::-1] + name[place + 2:]
    assert edits(swapped, name) <= 1
