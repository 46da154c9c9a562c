# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the tolerance of the solver changes of a run."""

import numpy as np
import pytest
from tolerances import distances
from tolerances import run
from tolerances import TIMES


def test_tolerance_trades_accuracy_for_iterations():
    """The study would compare a run with itself, or another scene with it."""
    loose = run(8, **{'solver.tolerance': 0.1})
    tight = run(8, **{'solver.tolerance': 1e-4})
    assert len(loose.positions) == len(tight.positions) == len(TIMES)
    assert 1e-5 < max(distances(loose.positions, tight.positions)) < 0.1
    assert loose.iterations < 0.7 * tight.iterations
    assert 0.0 < tight.peak_stretch < 0.02


def test_distances_are_those_of_nodes():
    """A distance would be that of coordinates, or grow with the number of nodes."""
    places = np.zeros((3, 4, 3))
    assert distances([places, places], [places + 1.0, places]) == [pytest.approx(3.0**0.5), 0.0]
