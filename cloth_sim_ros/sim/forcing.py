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

"""What accelerates the nodes in one step besides the springs."""

from dataclasses import dataclass
from dataclasses import field

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim import bindings
import numpy as np


@dataclass(frozen=True, eq=False)
class Forcing:
    """
    Gravity and pushes over one step, weighted by how much of the step they act in.

    :param everywhere: on every free node [m/s2]
    :param pushed_everywhere: True when a push has part in ``everywhere``
    :param regions: acceleration [m/s2] by the bit of the nodes' push mask
    :param mask: the masks on the device; None when there are no ``regions``
    """

    everywhere: tuple[float, float, float]
    pushed_everywhere: bool = False
    regions: dict[int, np.ndarray] = field(default_factory=dict)
    mask: Buffer | None = None

    @property
    def has_regions(self) -> bool:
        """Tell whether some nodes are pushed and others are not."""
        return self.mask is not None

    def is_like(self, other: 'Forcing') -> bool:
        """Tell whether ``other`` accelerates every node the same."""
        return (
            self.everywhere == other.everywhere and self.mask is other.mask
            and self.regions.keys() == other.regions.keys()
            and all(np.array_equal(self.regions[slot], other.regions[slot])
                    for slot in self.regions))

    def apply(self, program: Program) -> None:
        """Set the uniforms of applied_acceleration.glsl in the program in use."""
        program.set_vectors('acceleration', self.everywhere)
        if self.mask is not None:
            accelerations = np.zeros((max(self.regions) + 1, 3))
            for slot, acceleration in self.regions.items():
                accelerations[slot] = acceleration
            program.set_vectors('region_acceleration', accelerations)
            program.set_bits('pushes_acting', sum(1 << slot for slot in self.regions))

    def bind(self) -> None:
        """Bind the masks for the next dispatch, if there are any."""
        if self.mask is not None:
            self.mask.bind_storage(bindings.PUSH_MASK)
