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

"""How far springs are from their rest length; bend springs do not count."""

from collections.abc import Sequence

from cloth_sim_ros.reference.springs import SpringSet
import numpy as np


def node_strain(springs: Sequence[SpringSet], positions: np.ndarray) -> np.ndarray:
    """Return the largest |l / L0 - 1| of the structural and shear springs at each node."""
    strain = np.zeros(positions.shape[:2])
    for spring_set in springs:
        if spring_set.family == 'bend':
            continue
        magnitude = np.abs(spring_set.strains(positions))
        for end in spring_set.ends(strain):
            np.maximum(end, magnitude, out=end)
    return strain
