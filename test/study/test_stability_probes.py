# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Rest state and limit of a hanging cloth, against a chain worked out by hand."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.stability_probes import hang
from cloth_sim_ros.study.stability_probes import hanging_scene
import numpy as np
import pytest

GRAVITY = 9.81


def _chain_limit(nodes, spacing):
    """Return 2 / sqrt(largest eigenvalue) of free nodes under tensions of the weight below."""
    below = np.arange(nodes - 1, 0, -1) * GRAVITY / spacing
    matrix = np.zeros((nodes, nodes))
    for edge, pull in enumerate(below):
        matrix[edge:edge + 2, edge:edge + 2] += pull * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return 2.0 / np.sqrt(np.linalg.eigvalsh(matrix[1:, 1:])[-1])


@pytest.mark.parametrize('nodes', [3, 20, 80])
def test_a_chain(nodes):
    """The limit of mode constraint would be predicted for other tensions."""
    scene = Scene(hanging_scene({'rows': nodes, 'cols': 1, 'height': 1.0}))
    assert hang(scene).limit == pytest.approx(
        _chain_limit(nodes, 1.0 / (nodes - 1)), rel=1e-4)


def test_spring_law_stretch_by_the_weight_below():
    """The cloth would begin away from rest, and its swing be taken for a blow-up."""
    scene = Scene(hanging_scene({
        'rows': 5, 'cols': 1, 'node_mass': 0.01, 'stiffness.structural': 1000.0,
        'stiffness.bend': 0.0, 'damping.bend': 0.0,
        'constraint.hard': [], 'constraint.springs': ['structural']}))
    heights = hang(scene).positions[:, 0, 2]
    stretch = heights[:-1] - heights[1:] - scene.spacing[1]
    np.testing.assert_allclose(
        stretch, 0.01 * GRAVITY / 1000.0 * np.array([4, 3, 2, 1]), rtol=1e-5)


def test_neither_mass_nor_stiffness_matters_to_hard_edges():
    """The horizontal line over the map of mode constraint would be wrong."""
    limits = [hang(Scene(hanging_scene({'rows': 8, 'cols': 8, **values}))).limit
              for values in ({'stiffness.structural': 1e3}, {'node_mass': 3.0},
                             {'stiffness.structural': 1e6})]
    np.testing.assert_allclose(limits, limits[0], rtol=1e-4)
