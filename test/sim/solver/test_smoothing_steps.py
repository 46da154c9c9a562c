# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.


"""The steps of smoothing suit the weights of the edges."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import hard_edges
from cloth_sim_ros.sim.solver.edge_law import implicit_springs
from cloth_sim_ros.sim.solver.smoothing_steps import smoothing_steps
import numpy as np
import pytest


def left_over(steps: tuple[float, float], eigenvalue: np.ndarray) -> np.ndarray:
    """Return what both steps leave of an error with ``eigenvalue``."""
    return (1.0 - steps[0] * eigenvalue) * (1.0 - steps[1] * eigenvalue)


def test_heavy_edges_are_smoothed_from_a_quarter_to_two():
    """An error that no coarser level can mend would stay, or grow."""
    steps = smoothing_steps(hard_edges(0.01))
    assert np.abs(left_over(steps, np.linspace(0.25, 2.0, 200))).max() < 0.45
    assert np.abs(left_over(steps, np.linspace(0.0, 2.0, 200))).max() <= 1.0


def test_without_edges_a_step_is_exact():
    """Nodes that nothing ties would not fall freely."""
    assert smoothing_steps(hard_edges(0.01, families=())) == (1.0, 1.0)


@pytest.mark.parametrize('stiffness', [1e-3, 1.0, 1e2, 1e6])
def test_no_error_grows(stiffness):
    """The preconditioner would not be positive, and the solve would break down."""
    scene = Scene({'stiffness.structural': stiffness, 'damping.structural': 0.0})
    steps = smoothing_steps(implicit_springs(scene, 0.01))
    # Both, as one after the other comes before and after the coarser levels.
    assert np.abs(left_over(steps, np.linspace(1e-6, 2.0, 500))).max() <= 1.0 + 1e-9
