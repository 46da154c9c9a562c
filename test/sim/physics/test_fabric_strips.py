# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Strips of a measured fabric against the heavy elastica and the beam, on any grid."""

from cloth_sim_ros.validation.strips import frequency
from cloth_sim_ros.validation.strips import hung
from cloth_sim_ros.validation.strips import stretch
from cloth_sim_ros.validation.strips import tip_of_elastica
import numpy as np
import pytest

# Chord angle [degrees] and drop of the tip over the length, by w L^3 / B.
ELASTICA = {
    1: (7.10, 0.1235), 4: (25.53, 0.4252), 8: (41.49, 0.6406), 16: (57.39, 0.7970),
    32: (69.50, 0.8785), 64: (77.19, 0.9201)}


def off(figure):
    """Return the relative error of a figure."""
    return abs(figure.value / figure.most - 1.0)


@pytest.mark.parametrize('load', ELASTICA)
def test_elastica_has_the_printed_values(within, load):
    """The oracle takes another branch, or the table another strip."""
    along, down = tip_of_elastica(load)
    angle, drop_of_tip = ELASTICA[load]
    within('drop of the tip over the length', abs(down - drop_of_tip), 1e-4)
    within('chord angle [degrees]', abs(np.degrees(np.arctan2(down, along)) - angle), 0.02)


@pytest.mark.parametrize(('lines', 'axis'), [
    (2, 1), (5, 1), (2, 0), pytest.param(3, 1, marks=pytest.mark.long),
    pytest.param(9, 1, marks=pytest.mark.long), pytest.param(5, 0, marks=pytest.mark.long)])
def test_a_strip_sags_alike_on_any_lines(context, any_mode, within, lines, axis):
    """By 0.51 of the beam's with 2 lines and 0.91 with 9, when a node stood for a cell."""
    within(f'{lines} lines, axis {axis}, drop of the tip, relative',
           off(hung(context, any_mode, 17, 0.5, lines, axis)[1]), 0.01)


@pytest.mark.parametrize('load', [
    pytest.param(load, marks=[] if load in (8, 64) else pytest.mark.long) for load in ELASTICA])
def test_chord_angle_of_the_heavy_elastica(context, any_mode, within, load):
    """Strips that hang far down would take another shape."""
    angle, drop = hung(context, any_mode, 33, load)
    within(f'w L^3 / B = {load}, chord angle, relative', off(angle), 0.01)
    within(f'w L^3 / B = {load}, drop of the tip, relative', off(drop), 0.01)


# An explicit mode comes to rest within 1e-3 here, which is what 33 columns are off by.
@pytest.mark.long
def test_sag_converges_at_second_order(context, within):
    """A border that counts for whole cells made it the first order."""
    errors = [
        off(hung(context, 'constraint', nodes, 4.0, 3)[1])
        for nodes in (9, 17, 33)]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    within(f'order of {errors}, below 2', 2.0 - float(orders.min()), 0.2)


@pytest.mark.parametrize('lines', [2, pytest.param(17, marks=pytest.mark.long)])
def test_frequency_of_a_strip_of_fabric(context, any_mode, within, lines):
    """The mass of the tip is that of half a cell."""
    within(f'{lines} lines, frequency of the first mode, relative',
           off(frequency(context, any_mode, 33, lines)), 0.01)


@pytest.mark.parametrize('lines', [2, 9])
@pytest.mark.parametrize('axis', [0, 1])
def test_a_hanging_strip_stretches_by_its_stiffness(context, any_mode, within, lines, axis):
    """By w L^2 / (2 E): lines at the border as stiff as others made a narrow strip stiffer."""
    within(f'{lines} lines, axis {axis}, stretch by weight, relative',
           off(stretch(context, any_mode, 17, lines, axis)), 0.005)
