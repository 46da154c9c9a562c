# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloths are in motion, and alike for all programs."""

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.study.paper.cloths import FIGURE_7
from cloth_sim_ros.study.paper.cloths import FIGURE_8
from cloth_sim_ros.study.paper.cloths import FIGURE_9
from cloth_sim_ros.study.paper.cloths import LIMITS
from cloth_sim_ros.study.paper.cloths import square
from cloth_sim_ros.study.paper.cloths import TWO_FAMILIES
from cloth_sim_ros.study.paper.serial_model import NumpyCloth
from cloth_sim_ros.study.paper.serial_model import serial_model
from cloth_sim_ros.study.paper_figures import PAPER_ADAPTIVE
import numpy as np
import pytest


@pytest.fixture(scope='module')
def context():
    """Return one context for all."""
    context = Context(single_thread=True)
    yield context
    context.close()


@pytest.mark.parametrize('side', [16, 36])
def test_an_adaptive_cloth_has_edges_at_their_limit(context, side):
    """The adaptive mode would be timed as springs alone, also where its state is refined."""
    cloth = square('adaptive', side)
    state = cloth.start(context)
    program = NumpyCloth(serial_model(cloth.scene(**PAPER_ADAPTIVE)), *state)
    program.step()
    print(f'measured: {program.held} constraints')
    assert program.held > 0
    free = ~cloth.scene().pinned_nodes()
    assert np.linalg.norm(state[1][free], axis=-1).min() > 0.0


def test_a_constraint_cloth_keeps_its_lengths(context):
    """Edges that are far from their lengths would be thrown about in the first step."""
    cloth = square('constraint', 12, TWO_FAMILIES)
    positions, _ = cloth.start(context)
    edges = serial_model(cloth.scene()).edges
    assert np.abs(edges.strains(positions.reshape(-1, 3).astype(float))).max() < 0.03


def test_hard_edges_are_those_of_the_cloth():
    """Cloths with and without bend edges would be timed alike."""
    assert square('constraint', 12).scene()['constraint.hard'] == (
        'structural', 'shear', 'bend')
    assert square('constraint', 12, TWO_FAMILIES).scene()['constraint.hard'] == TWO_FAMILIES


def test_each_figure_goes_up_to_the_limit():
    """A curve would end before the cloth that the paper calls real time."""
    for limit, figure in zip(LIMITS, (FIGURE_7, FIGURE_8, FIGURE_9)):
        assert limit in figure
        assert max(cloth.nodes for cloth in figure) == limit.nodes
        assert {cloth.method for cloth in figure} == {limit.method}
