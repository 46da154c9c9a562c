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

"""What every way of limiting the strain offers to the adaptive mode."""

from typing import Protocol

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.state import State
import numpy as np


class StrainLimit(Protocol):
    """
    A way to hold edges at their limit.

    ``tensions`` holds what each edge is held with; None where strain alone tells.
    """

    tensions: Buffer | None

    @property
    def is_idle(self) -> bool:
        """Tell whether it has nothing to hold, so that a mass-spring substep does the same."""

    def see(self, strain: float) -> None:
        """Take the largest strain, when it is idle; the first one says what cloth has come."""

    def next_length(self, acceleration: float) -> float:
        """
        Return the longest substep that may come next [s].

        :param acceleration: that no node exceeds by what is applied [m/s2]
        """

    def substep(self, state: State, forcing: Forcing, length: float, kick: float) -> None:
        """Step ``state`` on by ``length`` [s], with forces that act for ``kick`` [s]."""

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return the tension of every edge, of its spring and of what holds it, as modes do."""

    def forget(self) -> None:
        """Hold nothing, as at the start."""

    def delete(self) -> None:
        """Give back what it allocated."""
