# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The rule for substeps against a turning rod."""

import math

from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.reference.substeps import turn_substep
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest


def test_turn_of_a_rod():
    """The turning rate is not the speed across the edge over its length."""
    edges = edges_of(Scene({'rows': 2, 'cols': 1, 'height': 0.5}))
    positions = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.5]])
    velocities = np.array([[0.3, 0.0, 7.0], [0.0, -0.4, 3.0]])
    h = turn_substep(edges, positions, velocities)
    assert (0.5 / 0.5 * h)**2 / 2.0 == pytest.approx(0.0025)
    assert turn_substep(edges, positions, np.zeros((2, 3))) == math.inf
