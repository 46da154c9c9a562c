# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Loops of a measured fabric against the elastica: Peirce's heart and pear loops."""

from cloth_sim_ros.validation.loops import height
from cloth_sim_ros.validation.loops import height_of
from cloth_sim_ros.validation.loops import height_of_elastica
from cloth_sim_ros.validation.loops import LENGTH
from cloth_sim_ros.validation.loops import move_clamps
from cloth_sim_ros.validation.loops import settle
from cloth_sim_ros.validation.loops import strip
import numpy as np
import pytest

# Distance from the clamp to the lowest point, over the length, by w L^3 / B.
LOOPS = {
    'heart': {0: 0.1339, 8: 0.1384, 32: 0.1515, 64: 0.1676, 128: 0.1958, 512: 0.2960},
    'pear': {0: 0.4243, 8: 0.4250, 32: 0.4268, 64: 0.4290, 128: 0.4329, 512: 0.4468}}
KINDS_AND_LOADS = [(kind, load) for kind, heights in LOOPS.items() for load in heights]
# Columns of nodes: a heavy heart bends sharply beside its clamp.
COLUMNS = {
    **dict.fromkeys(KINDS_AND_LOADS, 33), ('heart', 32): 65, ('heart', 64): 65,
    ('heart', 128): 65, ('heart', 512): 97}
# In the ordinary run: one of each, of those that need few columns and soon come to rest.
SHORT = {('heart', 8), ('pear', 128)}


@pytest.mark.parametrize(('kind', 'load'), KINDS_AND_LOADS)
def test_elastica_has_the_printed_heights(within, kind, load):
    """The oracle takes another branch, or the table another shape."""
    within(f'{kind}, w L^3 / B = {load}, height over length',
           abs(height_of_elastica(kind, load) - LOOPS[kind][load]), 5e-5)


@pytest.mark.parametrize(('kind', 'load'), [
    pytest.param(*each, marks=[] if each in SHORT else pytest.mark.long)
    for each in KINDS_AND_LOADS])
def test_height_of_a_loop(context, any_mode, within, kind, load):
    """A length counted from the second node to the last but one is 3 % less on 33 columns."""
    found = height(context, any_mode, COLUMNS[kind, load], kind, load)
    within(f'{kind}, w L^3 / B = {load}, height, relative',
           abs(found.value / LOOPS[kind][load] - 1.0), 0.01)


@pytest.mark.long
@pytest.mark.parametrize('kind', LOOPS)
def test_loop_closed_by_moving_its_ends(context, any_mode, within, kind):
    """The shape depends on how the ends came together."""
    load, columns = 64, 65
    with strip(context, any_mode, columns, load) as simulation:
        for way in np.linspace(0.0, 1.0, 7)[1:]:
            move_clamps(simulation, 0.5 * LENGTH * (1.0 - way), -0.5 * np.pi * way)
        if kind == 'heart':
            # A heart is a pear whose ends are turned until they point upwards.
            for way in np.linspace(0.0, 1.0, 13)[1:]:
                move_clamps(simulation, 0.0, -0.5 * np.pi - np.pi * way)
        assert not simulation.pin_moves
        settle(simulation)
        found = height_of(simulation)
    within(f'{kind}, w L^3 / B = {load}, height, relative',
           abs(found / LOOPS[kind][load] - 1.0), 0.01)


# An explicit mode comes to rest within 1e-3 here, which is what 33 columns are off by.
@pytest.mark.long
@pytest.mark.parametrize(('kind', 'load'), [('heart', 64), ('pear', 64)])
def test_loops_converge_at_second_order(context, within, kind, load):
    """A free length that begins at a node makes it the first order."""
    found = [height(context, 'constraint', columns, kind, load) for columns in (17, 33, 65)]
    errors = [abs(figure.value / figure.most - 1.0) for figure in found]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    within(f'{kind}, order of {errors}, below 2', 2.0 - float(orders.min()), 0.2)
